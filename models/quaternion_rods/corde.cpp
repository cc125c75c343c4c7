#include <algorithm>

#include "models/entry.h"
#include "models/quaternion_rods/quaternion_rod.h"

namespace tress::models {
namespace {

/// CoRdE [Spillmann & Teschner 2007]: n edges between nodes x_i, a quaternion q_i for the
/// material frame of each. With e an edge, l its rest length and t(q) the first axis,
///
///     E = sum_edges l (EA (|e|/l - 1)^2 + kappa |e/|e| - t(q)|^2 + nu (|q|^2 - 1)^2)/2
///       + sum_joints (w - w_rest)^T diag(GJ, EI1, EI2) (w - w_rest)/(2 l),
///     w = 2 vec(conj(q_j) q_{j+1}) = l 2 B_k((q_j + q_{j+1})/2) . (q_{j+1} - q_j)/l,
///
/// l of a joint is the mean of its edges, |w| = 2 sin(angle/2). The paper's K ~ E r^2 is
/// replaced by the section's EI ~ E r^4. The coupling kappa (N) ties frames to edges, and
/// nu (N) keeps norms near 1 where the paper projects. The model therefore has no
/// constraints and a constant mass matrix. The clamp is a wall half an edge before the
/// first edge's middle: a joint of length l/2 between its frame and q_0 (second order).
///
/// Both penalties are in units of EI/l^2 and cause smaller errors than the scheme, at the
/// same order 2. A joint's moment is EI sin(u l)/l: softer by (u l)^2/6 in bending of
/// curvature u. The norm, |q|^2 = 1 - (u l)^2/(coupling + norm), softens it by twice
/// that. A light cantilever of length L bends lower by (l/L)^2 of its deflection. It
/// bends lower by 4/coupling of that because edges lag behind frames by V/kappa, V the
/// shear force. The defaults thus add 4 and 6 per cent to the errors. The stiffest
/// oscillations are those of the norms, with sqrt((coupling + norm) E/(2 rho))/l. That is
/// five times the 2 sqrt(E/rho)/l of stretch waves.
///
/// Inertia: mass lumped at the nodes, 4 rho (I1 + I2) l |q'|^2/2 = rho (I1 + I2) l
/// |omega|^2/2 (omega = 2 q' conj(q)). This is exact about the tangent; across it, where
/// the section has rho I only, it is twice too large, of order (r/L)^2 of the total.
/// Friction: gamma/l on w', and stretch_friction/l on |e|'.
///
/// In rotation vectors (rotation_vectors.h), norms are 1 and nu has no effect. The mass
/// matrix is not constant then.
///
/// Rotations between neighbours stay below 180 degrees.
struct CordeOptions {
  double coupling = 100;        // kappa l^2/EI
  double norm = 100;            // nu l^2/EI
  double stretch_friction = 0;  // force per rate of stretch, N s
};

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
      coordinates_parameter,
      renewal_parameter,
      maximal_solver_parameter};
  return all;
}

std::unique_ptr<System> make_corde(const Strand& strand, const Parameters& parameters,
                                   Effects effects) {
  return quaternion_rod(strand, rod_kind<CordeEdge>(&parameters), std::move(effects),
                        parameters);
}

}  // namespace

template <>
QuaternionRodKind<CordeEdge> rod_kind(const Parameters* options) {
  CordeOptions own;
  if (options != nullptr) {
    own = {.coupling = options->number("coupling"),
           .norm = options->number("norm"),
           .stretch_friction = options->number("stretch_friction_n_s")};
  }
  return {.model = "corde",
          .edge_of = [own](const Material& material, const Segment& segment) {
            return edge(material, segment, own);
          }};
}

ModelEntry corde_entry() {
  return {.id = "corde",
          .summary =
              "Cosserat rod of n edges; 3n positions and n quaternions held together by "
              "penalties",
          .source = "Spillmann & Teschner 2007",
          .parameters = corde_parameters(),
          .make = on_described_strand<make_corde>,
          .on_strand = make_corde};
}

}  // namespace tress::models
