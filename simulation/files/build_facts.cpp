#include "simulation/files/build_facts.h"

namespace tress::simulation {

const BuildFacts& build_facts() {
  static constexpr BuildFacts facts{TRESS_VERSION,  TRESS_GIT_COMMIT, TRESS_SOURCE_TREE,
                                    TRESS_COMPILER, TRESS_FLAGS,      TRESS_BUILD_TYPE};
  return facts;
}

}  // namespace tress::simulation
