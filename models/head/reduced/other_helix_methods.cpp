#include "models/head/helix_strand.h"
#include "models/head/lane_head.h"
#include "models/head/reduced/other_methods.h"
#include "models/head/reduced/reduced_model.h"
#include "models/head/stepping/stepping_head.h"

namespace tress::models {

std::unique_ptr<Head> other_helix_head(const HeadOptions& options, const HeadPack& pack) {
  return on_pack(pack, [&]<class T>(Instructions set) -> std::unique_ptr<Head> {
    return std::make_unique<SteppingHead<ReducedModel<HelixKind<T>>>>(options, set);
  });
}

}  // namespace tress::models
