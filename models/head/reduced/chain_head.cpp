#include "models/head/chain_strand.h"
#include "models/head/reduced/reduced_head.h"

namespace tress::models {
namespace {

template <class T>
using ChainHead = ReducedHead<ChainKind<T>>;

}  // namespace

std::unique_ptr<Head> chain_head(const HeadOptions& options, const HeadPack& pack) {
  // Joints turn so freely in a step that of 32 bits no digit is left of some corrections:
  // rounding grows from step to step until strands are lost.
  check_mended(options, pack);
  return reduced_head<ChainHead>(options, pack, other_chain_head);
}

}  // namespace tress::models
