#pragma once

#include <string>

#include "contract/parameters.h"
#include "models/maximal/maximal_system.h"
#include "models/strand/geometry.h"
#include "models/strand/strand.h"

namespace tress::models {

/// Position and motion of the root, clamped or free, at t = 0. The strand starts as a
/// rigid body that moves with it.
struct RootStart {
  StrandPlace place;   // place and frame of the root
  Vec velocity, spin;  // m/s; rad/s, world components

  /// Returns the velocity of a place that moves with the root, m/s.
  Vec velocity_of(const Vec& x) const { return velocity + cross(spin, x - place.x); }
};
/// Returns the start of a strand's root.
RootStart root_start(const Strand& strand);

/// Common data of all models with nodes at the segments' ends. Beyond the middle of the
/// last edge, where its frame is, the strand keeps its rest shape: there is no joint, and
/// no moment at a free tip.
struct NodalStrand {
  /// Nodes, masses and lengths lumped at them, motion of the root, typical sizes, and
  /// `others` further coordinates of size one without inertia, all 0. Edges have the
  /// directions of the shape's chords and the lengths of the segments, so all shapes of a
  /// strand have the same edge lengths. Throws InputError naming `model` unless the
  /// strand is a chain.
  NodalStrand(const Strand& strand, const std::string& model, std::size_t others);

  MaximalStrand parts;  // nodes, masses and root of the system
  RootStart root;       // start of the root
  /// Frames of the edges: the material frame in the middle of the segment, with e0 turned
  /// onto the chord by the minimal rotation.
  std::vector<Frame> initial, natural;  // frames of the edges, at t = 0 and at rest
};

/// Typical rate (1/s) of swinging and bending: sqrt(g/L + EI/(rho A L^4)), g = 10 m/s^2.
double typical_rate(const Strand& strand);

/// A point that moves with the root, `offset` (m) away from it in its frame.
Anchor root_anchor(const RootMotion& motion, const Vec& offset);
/// Node i of a clamped or free strand as a node of constraints.
Node constraint_node(const MaximalStrand& strand, int i);
/// Distance constraints that keep neighbouring nodes one segment length apart; the
/// clamped node is an anchor that moves with the root.
std::unique_ptr<ConstraintSet> inextensible(const MaximalStrand& parts,
                                            const Strand& strand);

/// The catalogue parameter for the linear solver of a maximal model.
inline constexpr Parameter maximal_solver_parameter{
    .name = "solver",
    .help = "solver of the model's linear equations; auto: by their structure",
    .choices = "auto|banded|klu"};
/// Returns the value of maximal_solver_parameter.
LinearKind maximal_solver(const Parameters& parameters);

}  // namespace tress::models
