#pragma once

#include <memory>
#include <span>

#include "contract/system.h"
#include "models/reduced/reduced_strand.h"

namespace tress::models {

/// Super-helix [Bertails, Audoly, Cani, Querleux, Leroy, Leveque 2006]: an inextensible
/// Kirchhoff rod of N segments, each a helix of constant Darboux vector. The unknowns are
/// the components of that vector: twist, curvature 1 and curvature 2, in 1/m, or fewer
/// with `modes`. Equations of motion
///
///     M(q) q'' + gamma l q' + K (q - q_rest) + gyroscopic terms = sum J^T f
///
/// with K = l diag(GJ, EI1, EI2) and mass integrals by Gauss-Legendre quadrature. Second
/// order in the segment length. Solving by `recursive` is O(N) [Bertails 2009]. Trees
/// only differ in branching parents. Throws InputError (see reduced_strand).
std::unique_ptr<System> super_helix(const Strand& strand, const ReducedOptions& options,
                                    Effects effects);

/// Returns the parameters that make_super_helix() reads.
std::span<const Parameter> super_helix_parameters();
/// Makes super_helix() with the options that `parameters` contain.
std::unique_ptr<System> make_super_helix(const Strand& strand,
                                         const Parameters& parameters, Effects effects);

/// Returns the parameters that make_super_helix_tree() reads.
std::span<const Parameter> super_helix_tree_parameters();
/// Returns the tree of models/reduced/trees.h that `parameters` choose, with their
/// material and root.
Strand described_tree(const Parameters& parameters);
/// Makes super_helix() of described_tree(parameters).
std::unique_ptr<System> make_super_helix_tree(const Parameters& parameters);

}  // namespace tress::models
