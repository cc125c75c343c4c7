#include "models/head/exact/clothoid_element.h"
#include "models/head/exact/exact_sweeps.h"
#include "models/head/packs.h"

namespace tress::models {

#define TRESS_PACK(Number, width) \
  template class ExactKernel<ClothoidKind<PackOf<Number, width>>>;
TRESS_EACH_PACK(TRESS_PACK)
#undef TRESS_PACK

}  // namespace tress::models
