#include "models/batch/make_batch.h"
#include "models/clothoid/clothoid.h"
#include "models/clothoid/super_clothoid.h"

namespace tress::models {

std::unique_ptr<System> super_clothoid_batch(std::span<const Strand> strands,
                                             const ReducedOptions& options,
                                             std::vector<Effects> effects) {
  return make_batch<RecursiveMechanics, ClothoidOf<Pack, 1>, ClothoidOf<Pack, 2>,
                    ClothoidOf<Pack, 3>>(strands, Unknown::linear_curvature, options,
                                         std::move(effects), super_clothoid);
}

}  // namespace tress::models
