#include "models/head/clothoid_strand.h"
#include "models/head/reduced/reduced_head.h"

namespace tress::models {
namespace {

template <class T>
using ClothoidHead = ReducedHead<ClothoidKind<T>>;

}  // namespace

std::unique_ptr<Head> stiff_clothoid_head(const LaneOptions& options,
                                          const HeadPack& pack) {
  check_for_clothoids(options);
  return reduced_head<ClothoidHead>(options, pack);
}

}  // namespace tress::models
