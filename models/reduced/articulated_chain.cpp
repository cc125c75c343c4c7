#include "models/reduced/articulated_chain.h"

#include "models/reduced/ball_chain.h"

namespace tress::models {

template class ReducedSystem<BallLink, 1>;
template class ReducedSystem<BallLink, 2>;
template class ReducedSystem<BallLink, 3>;
template class ExactTangent<BallLink, 1>;
template class ExactTangent<BallLink, 2>;
template class ExactTangent<BallLink, 3>;

std::unique_ptr<System> articulated_chain(const Strand& strand,
                                          const ReducedOptions& options,
                                          Effects effects) {
  return make_reduced_system<BallLink, BallLink>(
      reduced_strand(strand, Unknown::joint_angle, options, std::move(effects)),
      Unknown::joint_angle, options.dofs);
}

std::span<const Parameter> articulated_chain_parameters() { return reduced_parameters(); }

std::unique_ptr<System> make_articulated_chain(const Strand& strand,
                                               const Parameters& parameters,
                                               Effects effects) {
  return articulated_chain(strand, reduced_options(parameters), std::move(effects));
}

}  // namespace tress::models
