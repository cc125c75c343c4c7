#include "models/head/helix_strand.h"
#include "models/head/lane_block.h"
#include "models/head/reduced/reduced_model.h"

namespace tress::models {
namespace {

template <class T>
using HelixModel = ReducedModel<HelixKind<T>>;

}  // namespace

AnyLaneKernel helix_lanes(const LaneOptions& options, const HeadPack& pack) {
  check_for_reduced_head(options);
  return lanes_of<HelixModel>(options, pack);
}

}  // namespace tress::models
