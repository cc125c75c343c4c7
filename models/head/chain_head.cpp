#include "models/head/chain_strand.h"
#include "models/head/reduced_head.h"

namespace tress::models {

std::unique_ptr<Head> chain_head(const HeadOptions& options, const HeadPack& pack) {
  check_for_reduced_head(options, "chains of rigid links");
  return on_pack(pack, [&]<class T>(Instructions set) {
    return std::make_unique<ReducedHead<ChainKind<T>>>(options, set);
  });
}

}  // namespace tress::models
