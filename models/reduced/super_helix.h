#pragma once

#include <memory>
#include <span>

#include "contract/system.h"
#include "models/reduced/reduced_strand.h"

namespace tress::models {

/// Super-helix [Bertails, Audoly, Cani, Querleux, Leroy, Leveque 2006]: an inextensible
/// Kirchhoff rod of N segments, each a helix of constant Darboux vector; unknowns are its
/// components (twist, curvature 1, curvature 2 in 1/m; fewer by `modes`). Equations of
/// motion
///
///     M(q) q'' + gamma l q' + K (q - q_rest) + gyroscopic terms = sum J^T f
///
/// with K = l diag(GJ, EI1, EI2) and mass integrals by Gauss-Legendre points. Second
/// order in the segment length. Solving by `recursive` is O(N) [Bertails 2009]. Trees are
/// the same with branching parents. Throws InputError (see reduced_strand).
std::unique_ptr<System> super_helix(const Strand& strand, const ReducedOptions& options,
                                    Effects effects);

/// One to four strands as one system, one in each lane of the processor's vectors: what
/// super_helix says of each, coordinates and points one strand after the other, to
/// rounding and at the cost of one or little more. Effects of each strand see its own
/// points alone. Quadrature is that of the strand that needs most. Throws InputError
/// unless all are clamped and cut alike, and options say stiff tangent and recursive.
std::unique_ptr<System> super_helix_batch(std::span<const Strand> strands,
                                          const ReducedOptions& options,
                                          std::vector<Effects> effects);

std::span<const Parameter> super_helix_parameters();
std::unique_ptr<System> make_super_helix(const Strand& strand,
                                         const Parameters& parameters, Effects effects);

/// The trees of models/reduced/trees.h.
std::span<const Parameter> super_helix_tree_parameters();
std::unique_ptr<System> make_super_helix_tree(const Parameters& parameters);

}  // namespace tress::models
