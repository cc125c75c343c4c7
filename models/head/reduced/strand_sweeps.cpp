#include "models/reduced/strand_sweeps.h"

#include "models/head/chain_strand.h"
#include "models/head/helix_strand.h"
#include "models/head/reduced/swept_elements.h"

namespace tress::models {

std::unique_ptr<StrandSweeps> strand_sweeps(const ToSweep& strand, Unknown unknown,
                                            int modes) {
  // Where effects load points, systems of helices work on four points of an element at
  // once, and take two fifths less time than these sweeps. Without such loads they take a
  // quarter to two fifths more.
  if (unknown == Unknown::curvature && !depend_on_place(strand.made.front()->effects)) {
    return sweeps_of<HelixKind<double>>(strand, modes);
  }
  if (unknown == Unknown::joint_angle) return sweeps_of<ChainKind<double>>(strand, modes);
  return nullptr;
}

}  // namespace tress::models
