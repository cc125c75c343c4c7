#include "contract/input_error.h"
#include "contract/jacobian_choice.h"
#include "math/quaternion.h"
#include "models/entry.h"
#include "models/maximal/nodal_strand.h"
#include "models/maximal/nodal_system.h"

namespace tress::models {
namespace {

/// Kirchhoff's equations of an inextensible rod by finite differences, in the variables
/// of [Hou, Klapper, Si 1998]: material curvatures and twist (1/m) of n nodes. With the
/// tangent t, the moment m, the force F = N + T t (N across t), loads f per length,
///
///     m' + t x F = rho P ((omega . t) t)_t,     rho S x_tt = F' + f,     |t| = 1,
///
/// with primes for d/ds and P = I1 + I2; the section's inertia across t is neglected.
/// Moments follow from the curvatures, N and omega_t . t from the balance of moments. The
/// tension T follows from t . t_tt = -|t_t|^2, a boundary-value problem along the rod
/// with T = 0 at the tip. Then t_tt and omega_t give the acceleration of the curvatures.
///
/// The grid is staggered. Positions x_i, masses M_i and loads f_i (N) are at nodes 0
/// (clamped) to n. Frames D_j, omega_j, F_j are on the edges j of length l between nodes
/// j and j + 1. Moments and curvatures kappa_j = phi_j/d are at the joints of arc length
/// d between edges j - 1 and j. The first joint is between the clamp and edge 0 with d =
/// l/2. With Cayley's map, c = 1/(1 + |phi|^2/4),
///
///     D_j = D_{j-1} (1 + c ([phi]x + [phi]x^2/2))
///     omega_j = omega_{j-1} + D_{j-1} c (phi_t + phi x phi_t/2)
///     sigma = diag(GJ, EI1, EI2)/d (phi - phi_rest) + gamma/d phi_t
///     m_j = D_{j-1} (sigma + phi x sigma/2 + phi (phi . sigma)/4)
///
/// (m is work-conjugate to sigma: m . (omega_j - omega_{j-1}) = sigma . phi_t),
///
///     m_{j+1} - m_j + l t_j x F_j = rho P l ((omega . t) t)_t,   m = 0 beyond the tip
///     M_i x_i,tt = F_i - F_{i-1} + f_i,   x_0,tt the clamp's,   F = 0 beyond the tip
///     l t_j,tt = x_{j+1},tt - x_j,tt,   t_j . t_j,tt = -|t_j,t|^2
///
/// where the last line gives a tridiagonal system for T. phi_tt follows from
/// differentiating the second line.
///
/// Error O(h^2). The energy of the grid changes exactly by the power of friction, loads
/// and the clamp; in a plane the grid is that of der without stretch. No constraints: r =
/// a - a(t, q, v), M = 1, O(n).
///
/// The exact Jacobian, by derivative numbers, is dense, O(n^2), factored in O(n^3). The
/// elastic Jacobian is our reconstruction of the small-scale decomposition of [Hou,
/// Klapper, Si 1998], the terms of highest order,
///
///     kappa_tt = -(EI/rho S) kappa_ssss,   twist_tt = (GJ/rho P) twist_ss
///
/// and the corresponding friction terms: on the grid, the linear equations of a straight
/// strand at rest, constant and banded. With one solve per step, as in
/// linearly_implicit_midpoint or linearly_implicit_euler, they are implicit. Tension,
/// geometry and loads are explicit. So is the twist that bending causes in a naturally
/// curved strand, EI kappa/(rho P): the splitting is intended for naturally straight
/// strands.
///
/// Rest strains are those between the chords of the natural shape. Neighbouring edges
/// turn by less than pi.
struct KirchhoffNodalOptions {
  Jacobian jacobian = Jacobian::exact;
};

/// The vector of Cayley's map that turns one frame into the other: 2 tan(angle/2) along
/// the axis.
Vec turn(const Frame& before, const Frame& after) {
  const Quaternion p = quaternion_of(before), q = nearer(p, quaternion_of(after));
  const Vec phi = (1 / dot(p, q)) * turn_between(p, q);
  // At 2 tan(angle/2) = 1e6 the angle is 4e-6 short of pi: no grid for that shape.
  if (!(dot(phi, phi) < 1e12)) {
    throw InputError("neighbouring elements are turned by pi", "kirchhoff_nodal",
                     "take more elements for this shape");
  }
  return phi;
}

/// Throws InputError unless the strand is a chain on a clamp whose neighbouring edges
/// turn by less than pi.
std::unique_ptr<System> kirchhoff_nodal(const Strand& strand,
                                        const KirchhoffNodalOptions& options,
                                        Effects effects) {
  check_unbranched(strand, "kirchhoff_nodal");
  if (strand.free_root) {
    throw InputError("curvatures do not say where a free root is", "kirchhoff_nodal",
                     "use a clamped root, or der, corde or super_helix");
  }
  const NodalStrand nodal(strand, "kirchhoff_nodal", 0);
  NodalParts parts;
  for (const MaximalStrand::MassPoint& point : nodal.parts.mass) {
    parts.rod.mass.push_back(point.mass);
    parts.node_length.push_back(point.length);
    parts.node_arc.push_back(point.arc);
  }
  for (std::size_t j = 0; j < strand.segments.size(); ++j) {
    const Segment& segment = strand.segments[j];
    const Segment* before = j > 0 ? &strand.segments[j - 1] : nullptr;
    const auto of_joint = [&](const std::vector<Frame>& edges) {
      return turn(j > 0 ? edges[j - 1] : nodal.root.place.frame, edges[j]);
    };
    const double arc = (segment.length + (before != nullptr ? before->length : 0)) / 2;
    parts.rod.length.push_back(segment.length);
    parts.rod.rotor.push_back(strand.material_of(segment).density *
                              segment.section.polar() * segment.length);
    parts.rod.arc.push_back(arc);
    parts.rod.joints.push_back(
        rod_joint(strand, before, segment, of_joint(nodal.natural)));
    const Vec start = (1 / arc) * of_joint(nodal.initial);
    parts.start.insert(parts.start.end(), {start.x, start.y, start.z});
  }
  parts.root = strand.root;
  parts.curvature = 1 / strand.length();
  parts.rate = typical_rate(strand);
  parts.jacobian = options.jacobian;
  parts.effects = std::move(effects);
  return std::make_unique<NodalSystem>(std::move(parts));
}

std::span<const Parameter> kirchhoff_nodal_parameters() {
  return {&jacobian_parameter, 1};
}

std::unique_ptr<System> make_kirchhoff_nodal(const Strand& strand,
                                             const Parameters& parameters,
                                             Effects effects) {
  return kirchhoff_nodal(strand, {.jacobian = jacobian_choice(parameters)},
                         std::move(effects));
}

}  // namespace

ModelEntry kirchhoff_nodal_entry() {
  return {.id = "kirchhoff_nodal",
          .summary =
              "Kirchhoff's equations by finite differences; 3n curvatures and twists of "
              "inextensible edges: our reconstruction",
          .source = "Hou, Klapper & Si 1998",
          .parameters = kirchhoff_nodal_parameters(),
          .make = on_described_strand<make_kirchhoff_nodal>,
          .on_strand = make_kirchhoff_nodal,
          .roots = Roots::clamped};
}

}  // namespace tress::models
