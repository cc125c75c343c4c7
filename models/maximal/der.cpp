#include "models/maximal/der.h"

#include "contract/tangent_choice.h"
#include "models/maximal/der_elasticity.h"
#include "models/maximal/nodal_strand.h"

namespace tress::models {

std::unique_ptr<System> der(const Strand& strand, const DerOptions& options,
                            Effects effects) {
  const std::size_t n = strand.segments.size();
  NodalStrand nodal(strand, "der", n);
  MaximalStrand& parts = nodal.parts;
  std::vector<DerElasticity::EdgeData> edges;
  for (std::size_t i = 0; i < n; ++i) {
    const Segment& segment = strand.segments[i];
    const double stretch =
        strand.material.youngs_modulus * segment.section.area() / segment.length;
    edges.push_back(
        {nodal.initial[i], segment.length, options.inextensible ? 0.0 : stretch});
    if (!options.quasi_static_twist) {
      parts.inertia[i] =
          strand.material.density * segment.section.polar() * segment.length;
    }
    // The frames of a rigid motion turn with the whole.
    parts.rate[3 * (n + 1) + i] = dot(nodal.root.spin, nodal.initial[i].e0);
  }
  std::vector<RodJoint> joints;
  for (std::size_t i = 0; i < n; ++i) {
    const Segment* before = i > 0 ? &strand.segments[i - 1] : nullptr;
    if (before == nullptr && !parts.clamped) continue;
    const Vec rest =
        joint_strain(before != nullptr ? nodal.natural[i - 1] : nodal.root.place.frame,
                     nodal.natural[i]);
    joints.push_back(rod_joint(strand.material, before, strand.segments[i], rest));
  }
  parts.elasticity = std::make_unique<DerElasticity>(std::move(edges), std::move(joints),
                                                     parts.clamped, options.tangent);
  if (options.inextensible) parts.constraints = inextensible(parts, strand);
  parts.effects = std::move(effects);
  parts.solver = options.solver;
  parts.tangent = options.tangent;
  return std::make_unique<MaximalSystem>(std::move(parts));
}

std::span<const Parameter> der_parameters() {
  static constexpr std::array all{
      Parameter{.name = "stretch",
                .help = "springs of stiffness EA, or edges of constant length",
                .choices = "extensible|inextensible"},
      Parameter{.name = "twist",
                .help = "angles with the section's inertia, or without",
                .choices = "dynamic|quasi_static"},
      tangent_parameter, maximal_solver_parameter};
  return all;
}

std::unique_ptr<System> make_der(const Strand& strand, const Parameters& parameters,
                                 Effects effects) {
  DerOptions options;
  options.inextensible = parameters.word("stretch") == "inextensible";
  options.quasi_static_twist = parameters.word("twist") == "quasi_static";
  options.tangent = tangent_choice(parameters);
  options.solver = maximal_solver(parameters);
  return der(strand, options, std::move(effects));
}

}  // namespace tress::models
