#include "models/clothoid/super_clothoid.h"

#include "contract/input_error.h"
#include "models/clothoid/clothoid.h"
#include "models/reduced/reduced_system.h"
#include "models/reduced/super_helix.h"
#include "models/strand/strand_parameters.h"

namespace tress::models {
namespace {

/// Those of helices, but for the points.
std::vector<Parameter> own_parameters(std::span<const Parameter> of_helices) {
  std::vector<Parameter> own(of_helices.begin(), of_helices.end());
  const auto points = std::ranges::find(own, "quadrature", &Parameter::name);
  points->help =
      "Gauss-Legendre points per element for mass and kinematics, at least 4; 0: chosen "
      "by the angle that the element winds";
  points->max = most_clothoid_points;
  return own;
}

void check(const ReducedOptions& options) {
  refuse_if(options.quadrature != 0 && (options.quadrature < Pack::lanes ||
                                        options.quadrature > most_clothoid_points),
            std::to_string(options.quadrature) + " points cannot tell a clothoid",
            "model option quadrature",
            "give 4 to " + std::to_string(most_clothoid_points) + ", or 0");
}

}  // namespace

std::unique_ptr<System> super_clothoid(const Strand& strand,
                                       const ReducedOptions& options, Effects effects) {
  check(options);
  return make_reduced_system<ClothoidOf<double, 3>, ClothoidOf<double, 1>,
                             ClothoidOf<double, 2>>(
      reduced_strand(strand, Unknown::linear_curvature, options, std::move(effects)),
      Unknown::linear_curvature, options.dofs);
}

std::span<const Parameter> super_clothoid_parameters() {
  static const std::vector<Parameter> all = own_parameters(super_helix_parameters());
  return all;
}

std::unique_ptr<System> make_super_clothoid(const Strand& strand,
                                            const Parameters& parameters,
                                            Effects effects) {
  return super_clothoid(strand, reduced_options(parameters), std::move(effects));
}

std::span<const Parameter> super_clothoid_tree_parameters() {
  static const std::vector<Parameter> all = own_parameters(super_helix_tree_parameters());
  return all;
}

std::unique_ptr<System> make_super_clothoid_tree(const Parameters& parameters) {
  return super_clothoid(described_tree(parameters), reduced_options(parameters),
                        strand_effects(parameters));
}

}  // namespace tress::models
