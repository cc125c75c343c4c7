#include "models/reduced/super_helix.h"

#include "models/reduced/reduced_system.h"
#include "models/strand/strand_parameters.h"

namespace tress {

std::unique_ptr<System> super_helix(const Strand& strand, const ReducedOptions& options,
                                    Effects effects) {
  return make_reduced_system<Helix>(
      reduced_strand(strand, Unknown::curvature, options, std::move(effects)),
      options.dofs);
}

std::span<const Parameter> super_helix_parameters() {
  static const std::vector<Parameter> all = with_strand_parameters(reduced_parameters());
  return all;
}

std::unique_ptr<System> make_super_helix(const Parameters& parameters) {
  return super_helix(strand(parameters), reduced_options(parameters),
                     strand_effects(parameters));
}

}  // namespace tress
