#pragma once

#include <cstddef>
#include <optional>

#include "math/frame.h"
#include "models/strand/rod_joint.h"

namespace tress::models {

/// Kind of a joint: the parts that it holds together.
enum class JointKind {
  ball,   // places
  weld,   // places and rotations
  hinge,  // places, and rotations except those about an axis
  spring  // nothing: a spring and a damper act between the points
};

/// A material point of a strand.
struct StrandPoint {
  std::size_t strand = 0;  // number of the strand in its system
  int point = 0;           // of MaterialPoints

  bool operator==(const StrandPoint&) const = default;
};

/// A joint of two points of strands, or of one strand.
struct Joint {
  JointKind kind = JointKind::ball;  // parts that are held together
  StrandPoint a{};                   // first end
  StrandPoint b{};                   // second end
  /// Axis of a hinge at the start, world components, of any length.
  Vec axis{};
  // Of a spring.
  double stiffness = 0;    // N/m
  double damping = 0;      // N s/m
  double rest_length = 0;  // m
  /// Joints of half an edge at both ends, of models whose edges do not bend.
  RodJoint half_a{}, half_b{};
  /// Sections of the rod at both ends at the start, seen from those that the model has
  /// where half an edge is natural. None: the halves begin in their natural shape at
  /// t = 0.
  std::optional<Frame> begin_a{}, begin_b{};  // at either end
};

}  // namespace tress::models
