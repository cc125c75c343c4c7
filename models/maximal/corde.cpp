#include "models/maximal/corde.h"

#include <algorithm>

#include "models/maximal/corde_elasticity.h"
#include "models/maximal/nodal_strand.h"
#include "models/strand/strand_parameters.h"

namespace tress {
namespace {

CordeEdge edge(const Material& material, const Segment& segment,
               const CordeOptions& options) {
  const CrossSection& section = segment.section;
  const double l = segment.length;
  const double bending =
      material.youngs_modulus * std::max(section.inertia1(), section.inertia2());
  return {.length = l,
          .stretch = material.youngs_modulus * section.area() / l,
          .stretch_friction = options.stretch_friction / l,
          .coupling = options.coupling * bending / l,
          .norm = options.norm * bending / l};
}

}  // namespace

std::unique_ptr<System> corde(const Strand& strand, const CordeOptions& options,
                              Effects effects) {
  const std::size_t n = strand.segments.size();
  NodalStrand nodal(strand, "corde", 4 * n);
  MaximalStrand& parts = nodal.parts;
  const Quaternion root = quaternion_of(nodal.root.place.frame);
  std::vector<CordeEdge> edges;
  std::vector<RodJoint> joints;
  Quaternion now = root, natural = root;  // neighbours on the same side of the sphere
  for (std::size_t i = 0; i < n; ++i) {
    const Segment& segment = strand.segments[i];
    edges.push_back(edge(strand.material, segment, options));
    now = nearer(now, quaternion_of(nodal.initial[i]));
    const std::size_t at = 3 * (n + 1) + 4 * i;
    store_quaternion(now, &parts.z[at]);
    store_quaternion(rate_of(now, nodal.root.spin), &parts.rate[at]);
    std::fill_n(&parts.inertia[4 * i], 4,
                4 * strand.material.density * segment.section.polar() * segment.length);
    const Quaternion before = natural;
    natural = nearer(before, quaternion_of(nodal.natural[i]));
    if (i == 0 && !parts.clamped) continue;
    joints.push_back(rod_joint(strand.material, i > 0 ? &strand.segments[i - 1] : nullptr,
                               segment, turn_between(before, natural)));
  }
  parts.elasticity = std::make_unique<CordeElasticity>(std::move(edges),
                                                       std::move(joints), parts.clamped);
  parts.effects = std::move(effects);
  parts.solver = options.solver;
  return std::make_unique<MaximalSystem>(std::move(parts));
}

std::span<const Parameter> corde_parameters() {
  static const std::vector<Parameter> all = with_strand_parameters(
      std::array{Parameter{.name = "coupling",
                           .help = "stiffness between frames and edges over EI/l^2",
                           .number = CordeOptions{}.coupling,
                           .min = 1},
                 Parameter{.name = "norm",
                           .help = "stiffness of the quaternions' norms over EI/l^2",
                           .number = CordeOptions{}.norm,
                           .min = 1},
                 Parameter{.name = "stretch_friction_n_s",
                           .help = "force per rate of stretch, N s",
                           .min = 0},
                 maximal_solver_parameter});
  return all;
}

std::unique_ptr<System> make_corde(const Parameters& parameters) {
  return corde(strand(parameters),
               {.coupling = parameters.number("coupling"),
                .norm = parameters.number("norm"),
                .stretch_friction = parameters.number("stretch_friction_n_s"),
                .solver = maximal_solver(parameters)},
               strand_effects(parameters));
}

}  // namespace tress
