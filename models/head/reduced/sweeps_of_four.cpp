#include "models/head/chain_strand.h"
#include "models/head/helix_strand.h"
#include "models/head/reduced/swept_elements.h"
#include "models/reduced/strand_sweeps.h"

namespace tress::models {

std::unique_ptr<StrandSweepsOf<Pack>> sweeps_of_four(const ToSweep& strands,
                                                     Unknown unknown, int modes) {
  switch (unknown) {
    case Unknown::curvature:
      return sweeps_of<HelixKind<Pack>>(strands, modes);
    case Unknown::joint_angle:
      return sweeps_of<ChainKind<Pack>>(strands, modes);
    case Unknown::linear_curvature:
      break;
  }
  return nullptr;
}

}  // namespace tress::models
