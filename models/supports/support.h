#pragma once

#include <vector>

#include "models/motion/root_motion.h"
#include "models/strand/rod_joint.h"

namespace tress::models {

/// Part of a section's rotation that a support holds, if the model determines it.
enum class HeldPart {
  nothing,  // no part
  tangent,  // direction of the strand
  frame     // direction and twist
};

/// Spring and damper of a compliant support, which exert forces in place of constraints.
/// A stiffness of 0 means a rigid support, whose damping is not used.
struct Compliance {
  double stiffness = 0;       // N/m, in each held direction
  double damping = 0;         // N s/m
  double turn_stiffness = 0;  // N m/rad, about each held axis
  double turn_damping = 0;    // N m s/rad
};

/// A support of a material point of a strand by a path in space.
struct Support {
  int point = 0;    // of MaterialPoints
  RootMotion path;  // place of the support over time, and its frame
  /// Directions in which the point is held, orthonormal; none: its place is free.
  std::vector<Vec> axes{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  HeldPart section = HeldPart::nothing;  // held by the path's frame
  /// Axis of a hinge, in the components of the path's frame and across its e0: the held
  /// part turns freely about it. 0: no hinge.
  Vec hinge{};
  RodJoint half_edge{};  // joint of half an edge to the path's frame (HalfJoint)
  /// The model's section at the start, seen from the path's frame. It differs from that
  /// frame if the half edge begins strained. Read by half joints only.
  Frame begin{};
  Compliance compliance{};  // springs in place of constraints

  /// Returns true if a spring holds the place.
  bool sprung() const { return compliance.stiffness > 0 && !axes.empty(); }
  /// Returns true if a spring holds the section.
  bool turn_sprung() const {
    return compliance.turn_stiffness > 0 && section != HeldPart::nothing;
  }
  /// Returns the directions in which the point is held by constraints.
  const std::vector<Vec>& rigid_axes() const {
    static const std::vector<Vec> none;
    return sprung() ? none : axes;
  }
};

}  // namespace tress::models
