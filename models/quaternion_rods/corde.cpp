#include "models/quaternion_rods/corde.h"

#include <algorithm>

#include "models/maximal/nodal_strand.h"
#include "models/quaternion_rods/corde_edge.h"
#include "models/quaternion_rods/quaternion_rod.h"

namespace tress::models {
namespace {

CordeEdge edge(const Material& material, const Segment& segment,
               const CordeOptions& options) {
  const CrossSection& section = segment.section;
  const double l = segment.length;
  const double bending =
      material.youngs_modulus * std::max(section.inertia1(), section.inertia2());
  const double coupling = options.coupling * bending / l;
  return {.length = l,
          .stiffness = {material.youngs_modulus * section.area() / l, coupling, coupling,
                        coupling, options.norm * bending / l},
          .friction = {options.stretch_friction / l}};
}

}  // namespace

std::unique_ptr<System> corde(const Strand& strand, const CordeOptions& options,
                              Effects effects) {
  return quaternion_rod<CordeEdge>(
      strand, "corde",
      [&](const Segment& segment) { return edge(strand.material, segment, options); }, 0,
      std::move(effects), options.solver);
}

std::span<const Parameter> corde_parameters() {
  static constexpr std::array all{
      Parameter{.name = "coupling",
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
      maximal_solver_parameter};
  return all;
}

std::unique_ptr<System> make_corde(const Strand& strand, const Parameters& parameters,
                                   Effects effects) {
  return corde(strand,
               {.coupling = parameters.number("coupling"),
                .norm = parameters.number("norm"),
                .stretch_friction = parameters.number("stretch_friction_n_s"),
                .solver = maximal_solver(parameters)},
               std::move(effects));
}

}  // namespace tress::models
