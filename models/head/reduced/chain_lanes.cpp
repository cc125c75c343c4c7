#include "models/head/chain_strand.h"
#include "models/head/lane_block.h"
#include "models/head/reduced/reduced_model.h"

namespace tress::models {
namespace {

template <class T>
using ChainModel = ReducedModel<ChainKind<T>>;

}  // namespace

AnyLaneKernel chain_lanes(const LaneOptions& options, const HeadPack& pack) {
  check_for_reduced_head(options);
  return lanes_of<ChainModel>(options, pack);
}

}  // namespace tress::models
