#pragma once

#include <memory>
#include <span>

#include "contract/system.h"
#include "models/reduced/reduced_strand.h"

namespace tress::models {

/// Super-clothoid [Casati, Bertails-Descoubes 2013], in a discontinuous form: an
/// inextensible Kirchhoff rod of N elements. The Darboux vector of each element is linear
/// in arc length and jumps between elements. Unknowns of an element are the mean of twist
/// and curvatures (1/m) and half their difference between its ends, 6 (4, 2 by `modes`).
/// The stiffness of the means is K = l diag(GJ, EI1, EI2), that of the half differences
/// K/3. Equations of motion, mass integrals, solvers and trees are those of super_helix.
/// Of fourth order in the length of elements once they wind by less than about 1.5 rad.
///
/// Throws InputError as reduced_strand, beyond the winding that clothoid_points allows,
/// and for `quadrature` below 4 or above most_clothoid_points, as its points also carry
/// the integrals of the kinematics (clothoid.h).
std::unique_ptr<System> super_clothoid(const Strand& strand,
                                       const ReducedOptions& options, Effects effects);

/// Returns the parameters that make_super_clothoid() reads.
std::span<const Parameter> super_clothoid_parameters();
/// Makes super_clothoid() with the options that `parameters` contain.
std::unique_ptr<System> make_super_clothoid(const Strand& strand,
                                            const Parameters& parameters,
                                            Effects effects);

/// Returns the parameters that make_super_clothoid_tree() reads.
std::span<const Parameter> super_clothoid_tree_parameters();
/// Makes a tree of models/reduced/trees.h of super-clothoids, chosen by `parameters`.
std::unique_ptr<System> make_super_clothoid_tree(const Parameters& parameters);

}  // namespace tress::models
