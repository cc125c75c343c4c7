#include "models/quaternion_rods/xpbd_cosserat.h"

#include <algorithm>

#include "models/maximal/nodal_strand.h"
#include "models/quaternion_rods/cosserat_edge.h"
#include "models/quaternion_rods/quaternion_rod.h"

namespace tress::models {
namespace {

CosseratEdge edge(const Material& material, const Segment& segment,
                  const XpbdCosseratOptions& options) {
  const CrossSection& section = segment.section;
  const double l = segment.length;
  const double bending =
      material.youngs_modulus * std::max(section.inertia1(), section.inertia2());
  const double shear = l * options.shear_factor * material.shear_modulus * section.area();
  return {.length = l,
          .stiffness = {l * material.youngs_modulus * section.area(), shear, shear,
                        options.norm * bending / l},
          .friction = {}};
}

}  // namespace

std::unique_ptr<System> xpbd_cosserat(const Strand& strand,
                                      const XpbdCosseratOptions& options,
                                      Effects effects) {
  return quaternion_rod<CosseratEdge>(
      strand, "xpbd_cosserat",
      [&](const Segment& segment) { return edge(strand.material, segment, options); },
      options.edge_inertia, std::move(effects), options.solver);
}

std::span<const Parameter> xpbd_cosserat_parameters() {
  static constexpr std::array all{
      Parameter{.name = "shear_factor",
                .help = "stiffness against shear over GA",
                .number = XpbdCosseratOptions{}.shear_factor,
                .min = 1e-6},
      Parameter{.name = "norm",
                .help = "stiffness of the quaternions' norms over EI/l^2",
                .number = XpbdCosseratOptions{}.norm,
                .min = 1},
      Parameter{.name = "edge_inertia",
                .help = "of quaternions beside the section's own, over rho A l^3",
                .number = XpbdCosseratOptions{}.edge_inertia,
                .min = 0},
      maximal_solver_parameter};
  return all;
}

std::unique_ptr<System> make_xpbd_cosserat(const Strand& strand,
                                           const Parameters& parameters,
                                           Effects effects) {
  return xpbd_cosserat(strand,
                       {.shear_factor = parameters.number("shear_factor"),
                        .norm = parameters.number("norm"),
                        .edge_inertia = parameters.number("edge_inertia"),
                        .solver = maximal_solver(parameters)},
                       std::move(effects));
}

}  // namespace tress::models
