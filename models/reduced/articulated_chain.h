#pragma once

#include <memory>
#include <span>

#include "contract/system.h"
#include "models/reduced/reduced_strand.h"

namespace tress::models {

/// Serial chain of rigid links with ball joints, bending and twisting springs and rest
/// angles [Hadap, Magnenat-Thalmann 2001; Hadap 2006]. Unknowns are the rotation vectors
/// of the joints (rad). A joint represents half of each adjacent link: stiffness
/// diag(GJ, EI1, EI2)/l with l that arc length, so the joint at the clamp is twice as
/// stiff. A free root is the frame before the first joint. It has no mass, so the joint
/// is at rest in it, and the first link moves as if it were the root.
/// (Traits::regular_mass is then false, and there is no ExplicitForm.) Solved by
/// Featherstone's articulated-body sweep with stiffness and friction inside, or by the
/// dense matrix of composite bodies. Throws InputError (see reduced_strand).
std::unique_ptr<System> articulated_chain(const Strand& strand,
                                          const ReducedOptions& options, Effects effects);

/// Returns the parameters that make_articulated_chain() reads.
std::span<const Parameter> articulated_chain_parameters();
/// Makes articulated_chain() with the options that `parameters` contain.
std::unique_ptr<System> make_articulated_chain(const Strand& strand,
                                               const Parameters& parameters,
                                               Effects effects);

}  // namespace tress::models
