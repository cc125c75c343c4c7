#pragma once

#include <string>

#include "contract/parameters.h"
#include "models/maximal/maximal_system.h"
#include "models/strand/geometry.h"
#include "models/strand/strand.h"

namespace tress::models {

/// Where the root, clamped or free, is at t = 0 and how it moves there. The strand starts
/// as a rigid body with it.
struct RootStart {
  StrandPlace place;
  Vec velocity, spin;  // m/s; rad/s, world components

  Vec velocity_of(const Vec& x) const { return velocity + cross(spin, x - place.x); }
};
RootStart root_start(const Strand& strand);

/// What every model with nodes at the segments' ends has in common. From the middle of
/// the last edge on, where its frame is, the strand is as at rest: it has no joint there,
/// and at a free tip no moment.
struct NodalStrand {
  /// Nodes, masses and lengths lumped at them, motion of the root, typical sizes, and
  /// `others` further coordinates of size one without inertia, all 0. Edges have the
  /// directions of the shape's chords and the lengths of the segments, so that shapes of
  /// one strand have edges of the same length. Throws InputError naming `model` unless
  /// the strand is a chain.
  NodalStrand(const Strand& strand, const std::string& model, std::size_t others);

  MaximalStrand parts;
  RootStart root;
  /// Of the edges, e0 along the chord: the material frame in the middle of the segment,
  /// turned on the shortest way.
  std::vector<Frame> initial, natural;
};

/// Typical rate (1/s) of swinging and bending of a strand of this length, stiffness and
/// weight: sqrt(g/L + EI/(rho A L^4)), g = 10 m/s^2.
double typical_rate(const Strand& strand);

/// A point that moves with the root, `offset` (m) away from it in its frame.
Anchor root_anchor(const RootMotion& motion, const Vec& offset);
/// Node i of a clamped or free strand as a node of constraints.
Node constraint_node(const MaximalStrand& strand, int i);
/// Constraints of distance between neighbouring nodes, the lengths of the segments apart,
/// with the clamped node as an anchor that moves with the root.
std::unique_ptr<ConstraintSet> inextensible(const MaximalStrand& parts,
                                            const Strand& strand);

/// The catalogue parameter and choice of how a maximal model's equations are solved.
inline constexpr Parameter maximal_solver_parameter{
    .name = "solver",
    .help = "of the model's linear equations; auto: by their structure",
    .choices = "auto|banded|klu"};
LinearKind maximal_solver(const Parameters& parameters);

}  // namespace tress::models
