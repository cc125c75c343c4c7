#pragma once

#include "models/batch/reduced_batch.h"

namespace tress::models {

/// `alone` makes a single strand; One, Two and Three are the kernels for 1, 2 and 3
/// modes.
template <template <class, int> class Mechanics, class One, class Two, class Three>
std::unique_ptr<System> make_batch(
    std::span<const Strand> strands, Unknown unknown, const ReducedOptions& given,
    std::vector<Effects> effects,
    std::unique_ptr<System> (*alone)(const Strand&, const ReducedOptions&, Effects)) {
  const ReducedOptions options = with_same_points(strands, unknown, given);
  PackedStrands all = packed(strands, unknown, options, effects);
  std::vector<std::unique_ptr<System>> systems;
  for (std::size_t s = 0; s < strands.size(); ++s) {
    systems.push_back(alone(strands[s], options, std::move(effects[s])));
  }
  const auto make = [&]<class Kernel, int modes>() {
    return std::make_unique<ReducedBatch<Mechanics, Kernel, modes>>(std::move(all),
                                                                    std::move(systems));
  };
  switch (options.dofs) {
    case 1:
      return make.template operator()<One, 1>();
    case 2:
      return make.template operator()<Two, 2>();
    default:
      return make.template operator()<Three, 3>();
  }
}

}  // namespace tress::models
