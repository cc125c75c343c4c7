#include "models/head/clothoid_strand.h"
#include "models/head/lane_block.h"
#include "models/head/reduced/reduced_model.h"

namespace tress::models {
namespace {

template <class T>
using ClothoidModel = ReducedModel<ClothoidKind<T>>;

}  // namespace

AnyLaneKernel clothoid_lanes(const LaneOptions& options, const HeadPack& pack) {
  check_for_reduced_head(options);
  check_for_clothoids(options);
  return lanes_of<ClothoidModel>(options, pack);
}

}  // namespace tress::models
