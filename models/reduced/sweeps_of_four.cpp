#include "models/reduced/strand_sweeps.h"
#include "models/reduced/swept_elements.h"

namespace tress::models {

std::unique_ptr<StrandSweepsOf<Pack>> sweeps_of_four(const ToSweep& strands,
                                                     Unknown unknown, int modes) {
  return sweeps_of<Pack>(strands, unknown, modes);
}

}  // namespace tress::models
