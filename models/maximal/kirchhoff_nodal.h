#pragma once

#include <memory>
#include <span>

#include "models/effects/effect.h"
#include "models/parameters.h"
#include "models/strand/strand.h"
#include "models/system.h"

namespace tress {

/// Kirchhoff's equations of an inextensible rod by finite differences, in the variables
/// of [Hou, Klapper, Si 1998]: material curvatures and twist (1/m) of n nodes. With the
/// tangent t, the moment m, the force n = N + T t (N across t), loads f per length,
///
///     m' + t x n = rho J ((omega . t) t)_t,     rho S x_tt = n' + f,     t . t_t = 0,
///
/// primes d/ds, rho J the inertia of the section about t (that across it is neglected),
/// J = I1 + I2. Moments follow from the curvatures, N and omega_t . t from their balance,
/// T from t . t_tt = -|t_t|^2, a boundary-value problem along the rod, T = 0 at the tip;
/// then t_tt, omega_t and from it the acceleration of the curvatures.
///
/// The grid is staggered: positions x_i, masses M_i and loads at nodes 0 (clamped) to n;
/// frames D_j, spins omega_j, forces n_j on the edges j between nodes j and j + 1;
/// moments and curvatures between edges j - 1 and j, joint 0 between the clamp and edge 0
/// with half the arc length d. With phi = d kappa and Cayley's map
///
///     D_j = D_{j-1} cay(phi),  cay(phi) = 1 + c ([phi]x + [phi]x^2/2),  c = 1/(1 +
///     |phi|^2/4), omega_j - omega_{j-1} = D_{j-1} c (phi_t + phi x phi_t/2),
///     sigma = diag(GJ, EI1, EI2)/d (phi - phi_rest) + gamma/d phi_t,
///     m = D_{j-1} (sigma + phi x sigma/2 + phi (phi . sigma)/4)
///
/// (that moment has the work of sigma: m . (omega_j - omega_{j-1}) = sigma . phi_t),
///
///     m_{j+1} - m_j + l t_j x n_j = rho J l ((omega . t) t)_t,    m = 0 beyond the tip
///     M_i x_i,tt = n_i - n_{i-1} + f_i,    t_j,tt = (x_{j+1},tt - x_j,tt)/l
///     (T_{j+1} t_{j+1} - T_j t_j)/M_{j+1} - (T_j t_j - T_{j-1} t_{j-1})/M_j, times t_j,
///       = -l |t_j,t|^2 - t_j . (the same of N and f)              (tridiagonal)
///     kappa_tt = cay'^-1 (omega_j,t - omega_{j-1},t - ...)/d.
///
/// Error O(h^2); the energy of the grid changes by the power of friction, loads and the
/// clamp exactly. No trigonometry, no constraints: r = a - a(t, q, v), M = 1, O(n).
///
/// exact tangent: by derivative numbers, dense, O(n^2), factored in O(n^3). stiff: the
/// small-scale decomposition of the paper, only the terms of highest order,
///
///     kappa_tt = -(EI/rho S) kappa_ssss,   twist_tt = (GJ/rho J) twist_ss
///
/// and their like in friction: on the grid the linear equations of a straight strand at
/// rest, constant and banded. One solve a step by linearly_implicit_midpoint or
/// semi_implicit_euler is then the paper's way to integrate; tension, geometry and loads
/// are explicit, and so is the twist that a naturally curved strand gets from bending,
/// EI kappa/(rho J): the splitting is one for naturally straight strands.
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
std::unique_ptr<System> make_kirchhoff_nodal(const Parameters& parameters);

}  // namespace tress
