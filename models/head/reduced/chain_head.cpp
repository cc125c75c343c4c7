#include "models/head/chain_strand.h"
#include "models/head/reduced/reduced_head.h"

namespace tress::models {
namespace {

template <class T>
using ChainHead = ReducedHead<ChainKind<T>>;

}  // namespace

std::unique_ptr<Head> chain_head(const HeadOptions& options, const HeadPack& pack) {
  // Joints turn so freely in a step that of 32 bits no digit is left of some corrections:
  // iterations mend that, one alone makes it grow from step to step.
  refuse_if(options.method == HeadMethod::linearly_implicit_midpoint &&
                pack.number == HeadNumber::float32,
            "rigid links in 32 bits, whose rounding a single correction does not mend",
            place_of_head, "use 64 bits, or tr_bdf2");
  return reduced_head<ChainKind, ChainHead>(options, pack);
}

}  // namespace tress::models
