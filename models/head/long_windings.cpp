#include "models/head/long_windings.h"

namespace tress::models {

template class LaneFunctions<PackOf<double, 1>>;
template class LaneFunctions<PackOf<double, 4>>;
template class LaneFunctions<PackOf<float, 8>>;
#ifndef TRESS_NARROW_PACKS
template class LaneFunctions<PackOf<double, 8>>;
template class LaneFunctions<PackOf<float, 16>>;
#endif

}  // namespace tress::models
