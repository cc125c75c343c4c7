#include "models/head/long_windings.h"

#include "models/head/packs.h"

namespace tress::models {

#define TRESS_PACK(Number, width) template class LaneFunctions<PackOf<Number, width>>;
TRESS_EACH_PACK(TRESS_PACK)
#undef TRESS_PACK

}  // namespace tress::models
