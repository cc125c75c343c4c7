#include "models/head/exact/exact_sweeps.h"
#include "models/head/exact/varied_link.h"
#include "models/head/packs.h"

namespace tress::models {

#define TRESS_PACK(Number, width) \
  template class ExactKernel<ChainKind<PackOf<Number, width>>>;
TRESS_EACH_PACK(TRESS_PACK)
#undef TRESS_PACK

}  // namespace tress::models
