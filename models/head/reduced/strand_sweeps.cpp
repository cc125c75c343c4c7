#include "models/reduced/strand_sweeps.h"

#include "models/head/chain_strand.h"
#include "models/head/reduced/swept_elements.h"

namespace tress::models {

std::unique_ptr<StrandSweeps> strand_sweeps(const ToSweep& strand, Unknown unknown,
                                            int modes) {
  // Systems of helices work on four points of an element at once, and take a fifth to two
  // fifths less time than these sweeps on scenes of 3 to 20 elements.
  if (unknown != Unknown::joint_angle) return nullptr;
  return sweeps_of<ChainKind<double>>(strand, modes);
}

}  // namespace tress::models
