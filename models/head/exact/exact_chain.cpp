#include "models/head/exact/exact_sweeps.h"
#include "models/head/exact/varied_link.h"

namespace tress::models {

template class ExactKernel<ChainKind<PackOf<double, 1>>>;
template class ExactKernel<ChainKind<PackOf<double, 4>>>;
template class ExactKernel<ChainKind<PackOf<float, 8>>>;
#ifndef TRESS_NARROW_PACKS
template class ExactKernel<ChainKind<PackOf<double, 8>>>;
template class ExactKernel<ChainKind<PackOf<float, 16>>>;
#endif

}  // namespace tress::models
