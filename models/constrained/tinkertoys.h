#pragma once

#include <memory>
#include <span>

#include "contract/parameters.h"
#include "contract/system.h"
#include "models/constrained/inextensible_chain.h"

namespace tress::models {

/// Structures of particles and modular constraints with one `size` s, at rest or spinning
/// rigidly about the vertical through the origin. Particles and constraint rows:
///
/// - chain: s and s; distances from an anchor.
/// - ring: s and s + 3; distances, one fixed point.
/// - net: s^2 and s (2 s - 1); distances, top row on anchors; no spin.
/// - tree: 2^s - 1 and 2^s - 1 + forks; distances, one angle per fork, forks = 2^(s-1) -
///   1.
/// - truss: 3 (s + 1) and 6 + 12 s; a fixed point, a rigid triangle, 12 bars per bay.
///
/// The truss is over-constrained: each bay of 3 particles (9 coordinates) has 12 bars. G
/// is rank-deficient by exactly 3 s everywhere, and the truss moves as a rigid body about
/// the origin.
enum class Structure { chain, ring, net, tree, truss };

/// `length` is that of the chain, the ring's perimeter, the net's side, the tree's height
/// or the truss; a net has no spin.
struct ToyShape : HangingShape {
  Structure structure = Structure::chain;  // arrangement of the particles
  int size = 4;                            // number of parts, by structure
};

/// Throws InputError on a size that the structure does not have.
ParticleScene tinkertoys(const ToyShape& shape);

/// Returns the parameters of the model.
std::span<const Parameter> tinkertoys_parameters();
/// Makes the model.
std::unique_ptr<System> make_tinkertoys(const Parameters& parameters);

}  // namespace tress::models
