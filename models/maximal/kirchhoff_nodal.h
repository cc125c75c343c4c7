#pragma once

#include <memory>
#include <span>

#include "contract/parameters.h"
#include "contract/system.h"
#include "models/effects/effect.h"
#include "models/strand/strand.h"

namespace tress::models {

/// Kirchhoff's equations of an inextensible rod by finite differences, in the variables
/// of [Hou, Klapper, Si 1998]: material curvatures and twist (1/m) of n nodes. With the
/// tangent t, the moment m, the force F = N + T t (N across t), loads f per length,
///
///     m' + t x F = rho P ((omega . t) t)_t,     rho S x_tt = F' + f,     |t| = 1,
///
/// with primes for d/ds and P = I1 + I2; the section's inertia across t is neglected.
/// Moments follow from the curvatures, N and omega_t . t from the balance of moments, and
/// the tension T from t . t_tt = -|t_t|^2, a boundary-value problem along the rod with
/// T = 0 at the tip; then t_tt and omega_t give the acceleration of the curvatures.
///
/// The grid is staggered: positions x_i, masses M_i and loads f_i (N) at nodes 0
/// (clamped) to n; frames D_j, omega_j, F_j on the edges j of length l between nodes j
/// and j + 1; moments and curvatures kappa_j = phi_j/d at the joints of arc length d
/// between edges j - 1 and j, the first between the clamp and edge 0 with d = l/2. With
/// Cayley's map, c = 1/(1 + |phi|^2/4),
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
/// and the clamp; in a plane the grid is that of der without stretch. No constraints:
/// r = a - a(t, q, v), M = 1, O(n).
///
/// The exact tangent, by derivative numbers, is dense, O(n^2), factored in O(n^3). The
/// stiff tangent is our reconstruction of the small-scale decomposition of [Hou, Klapper,
/// Si 1998], the terms of highest order,
///
///     kappa_tt = -(EI/rho S) kappa_ssss,   twist_tt = (GJ/rho P) twist_ss
///
/// and the corresponding friction terms: on the grid, the linear equations of a straight
/// strand at rest, constant and banded. With one solve per step, as in
/// linearly_implicit_midpoint or semi_implicit_euler, they are implicit; tension,
/// geometry and loads are explicit, and so is the twist that bending causes in a
/// naturally curved strand, EI kappa/(rho P): the splitting is meant for naturally
/// straight strands.
///
/// Rest strains are those between the chords of the natural shape. Neighbouring edges
/// turn by less than pi.
struct KirchhoffNodalOptions {
  Tangent tangent = Tangent::exact;
};

/// Throws InputError unless the strand is a chain on a clamp whose neighbouring edges
/// turn by less than pi.
std::unique_ptr<System> kirchhoff_nodal(const Strand& strand,
                                        const KirchhoffNodalOptions& options,
                                        Effects effects);

std::span<const Parameter> kirchhoff_nodal_parameters();
std::unique_ptr<System> make_kirchhoff_nodal(const Strand& strand,
                                             const Parameters& parameters,
                                             Effects effects);

}  // namespace tress::models
