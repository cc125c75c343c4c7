#include "models/head/chain_strand.h"
#include "models/head/reduced/reduced_head.h"

namespace tress::models {
namespace {

template <class T>
using ChainHead = ReducedHead<ChainKind<T>>;

}  // namespace

std::unique_ptr<Head> stiff_chain_head(const LaneOptions& options, const HeadPack& pack) {
  return reduced_head<ChainHead>(options, pack);
}

}  // namespace tress::models
