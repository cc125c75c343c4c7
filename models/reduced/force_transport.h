#pragma once

#include <memory>
#include <span>

#include "contract/system.h"
#include "models/reduced/reduced_strand.h"

namespace tress::models {

/// "Force transport" [Wang, Efficient Strand Dynamics for Real-Time Hair Simulation,
/// thesis, National Chiao Tung University]: a strand of rigid segments whose
/// accelerations are found one by one from the root. With d3 the tangent, the thesis
/// simplifies the special Cosserat theory to
///
///     r_l'' = int_0^l (omega' x d3 + omega x (omega x d3)) ds,
///
/// "the rest segments will move together": each segment's omega' follows from the forces
/// on it and on all beyond it, less the centripetal part, as though those beyond turned
/// with it.
///
/// This is a reconstruction, for the thesis's equations are not in the text that is left
/// of it. Kinematics, gravity, velocity terms, effects, bending and twist, rest angles
/// and friction are those of articulated_chain; of M(q) a = f(q, v) each joint keeps the
/// accelerations of the joints before it and its own, and drops those beyond it:
///
///     M_ft(q) a = f(q, v),    M_ft = block lower triangle of M, diagonal included,
///
/// solved from the root to the tip: the first sweep, from a = 0, of a block Gauss-Seidel
/// iteration on the chain's own equations. What this makes of a rod:
///
/// - equilibria are those of articulated_chain;
/// - straight, without gravity, joint j swings by itself, omega^2 = K_j / (its composite
///   inertia). For n >= 5 segments the slowest is the second joint,
///
///       omega^2 = 3 n / (1 - 1/n)^3  EI/(rho S L^4),
///
///   twice the rod's 3.516 sqrt(EI/(rho S L^4)) at n = 13, and growing with n: the
///   equations do not tend to those of the rod;
/// - M_ft is not symmetric, and energy is not conserved: the inertia left out does work,
///   v^T (M - M_ft) a, which `power` counts;
/// - M_ft^-1 K is far from normal: without gravity every mode keeps its size, and yet
/// small
///   random motions of a straight hair in the plane gain energy by 25 times at 5
///   segments, 400 at 10, a million at 40 within 0.1 s
///   (experiments/force_transport/main.cpp);
/// - under gravity small oscillations about rest grow: two hanging links without springs
///   have omega^2 = (0.89 +- 0.22 i) g/l. No step size helps; damping has to.
///
/// The thesis reports static errors that grow with n, "force lost in each integration";
/// these equations have none. Handing on only the axial part of the force from beyond
/// would lose some, but nothing left of the text says how, so that is not built.
///
/// Stiff tangent: block lower triangular, one sweep from the root, O(n), unless
/// options.method is `composite`, which makes it a dense matrix as the exact one always
/// is. Throws InputError unless the strand is a chain and clamped (see reduced_strand).
std::unique_ptr<System> force_transport(const Strand& strand,
                                        const ReducedOptions& options, Effects effects);

/// One to four strands as one system: see super_helix_batch.
std::unique_ptr<System> force_transport_batch(std::span<const Strand> strands,
                                              const ReducedOptions& options,
                                              std::vector<Effects> effects);

std::span<const Parameter> force_transport_parameters();
std::unique_ptr<System> make_force_transport(const Strand& strand,
                                             const Parameters& parameters,
                                             Effects effects);

}  // namespace tress::models
