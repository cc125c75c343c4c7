#include "models/head/exact/exact_sweeps.h"
#include "models/head/exact/varied_helix.h"

namespace tress::models {

template class ExactKernel<HelixKind<PackOf<double, 1>>>;
template class ExactKernel<HelixKind<PackOf<double, 4>>>;
template class ExactKernel<HelixKind<PackOf<float, 8>>>;
#ifndef TRESS_NARROW_PACKS
template class ExactKernel<HelixKind<PackOf<double, 8>>>;
template class ExactKernel<HelixKind<PackOf<float, 16>>>;
#endif

}  // namespace tress::models
