#pragma once

#include <memory>
#include <span>

#include "contract/system.h"
#include "models/reduced/reduced_strand.h"

namespace tress::models {

/// "Force transport" [Wang, Efficient Strand Dynamics for Real-Time Hair Simulation,
/// thesis, National Chiao Tung University]: a strand of rigid segments whose
/// accelerations are computed one by one from the root. With d3 the tangent, the thesis
/// simplifies the special Cosserat theory to
///
///     r_l'' = int_0^l (omega' x d3 + omega x (omega x d3)) ds,
///
/// "the rest segments will move together". The omega' of a segment follows from the
/// forces on it and on all segments beyond it, minus the centripetal part. The segments
/// beyond turn with it.
///
/// This is a reconstruction: the surviving text of the thesis lacks its equations.
/// Kinematics, gravity, velocity terms, effects, bending and twist, rest angles and
/// friction are those of articulated_chain. In M(q) a = f(q, v) each joint keeps its own
/// acceleration and those of the joints before it, and drops those beyond it:
///
///     M_ft(q) a = f(q, v),    M_ft = block lower triangle of M, diagonal included,
///
/// solved from the root to the tip: the first sweep, from a = 0, of a block Gauss-Seidel
/// iteration on the chain's equations. Consequences:
///
/// - equilibria are those of articulated_chain;
/// - in a straight strand without gravity, joint j swings independently, omega^2 = K_j /
///   (its composite inertia). For n >= 5 segments the slowest is the second joint,
///
///       omega^2 = 3 n / (1 - 1/n)^3  EI/(rho S L^4),
///
///   twice the rod's 3.516 sqrt(EI/(rho S L^4)) at n = 13, and growing with n: the
///   equations do not tend to those of the rod;
/// - M_ft is not symmetric, and energy is not conserved: the omitted inertia does work,
///   v^T (M - M_ft) a, which `power` counts;
/// - M_ft^-1 K is far from normal. Without gravity every mode keeps its amplitude. Yet
///   small random motions of a straight hair in the plane gain energy within 0.1 s. The
///   factor is 25 at 5 segments, 400 at 10, a million at 40
///   (experiments/force_transport/main.cpp);
/// - under gravity small oscillations about rest grow: two hanging links without springs
///   have omega^2 = (0.89 +- 0.22 i) g/l. Smaller steps do not help; damping is needed.
///
/// The thesis reports static errors that grow with n, "force lost in each integration";
/// these equations have none. Passing on only the axial part of the force from beyond
/// would cause some, but the surviving text does not say how, so it is not implemented.
///
/// The elastic Jacobian is block lower triangular, one sweep from the root, O(n), unless
/// options.method is `composite`, which makes it dense; the exact Jacobian is always
/// dense. Throws InputError unless the strand is a clamped chain (see reduced_strand).
std::unique_ptr<System> force_transport(const Strand& strand,
                                        const ReducedOptions& options, Effects effects);

/// Returns the parameters that make_force_transport() reads.
std::span<const Parameter> force_transport_parameters();
/// Makes force_transport() with the options that `parameters` contain.
std::unique_ptr<System> make_force_transport(const Strand& strand,
                                             const Parameters& parameters,
                                             Effects effects);

}  // namespace tress::models
