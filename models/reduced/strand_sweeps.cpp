#include "models/reduced/strand_sweeps.h"

#include "models/reduced/swept_elements.h"

namespace tress::models {

std::unique_ptr<StrandSweeps> strand_sweeps(const ToSweep& strand, Unknown unknown,
                                            int modes) {
  return sweeps_of<double>(strand, unknown, modes);
}

}  // namespace tress::models
