#pragma once

#include <Eigen/Core>
#include <string_view>
#include <vector>

#include "tests/models/reduced/static_equilibrium.h"

namespace tress::testing_support {

using namespace simulation;

/// Dense S(w) of a system at rest in q, out of its sparse form.
Eigen::MatrixXd dense_tangent(System& system, In q, Weights w);

/// (beta L)^2 of cosh(beta L) cos(beta L) = -1, the clamped-free beam of Euler and
/// Bernoulli: frequencies over sqrt(EI/(rho S L^4)).
inline constexpr double beam[3] = {3.516015268500151, 22.03449156466677,
                                   61.69721441354909};

/// The lowest frequencies (rad/s) of a strand at rest, ascending: K x = omega^2 M x on
/// the motions that the constraints allow.
std::vector<double> lowest_frequencies(std::string_view model,
                                       const ModelSettings& settings, int count);

/// Those of the three lowest pairs of bending modes of a straight clamped rod of circular
/// section.
std::vector<double> bending_frequencies(std::string_view model,
                                        const ModelSettings& settings);

}  // namespace tress::testing_support
