#pragma once

#include "math/frame.h"

namespace tress::models {

/// Root of a strand in the axes of the head at rest.
template <class T>
struct LaneRoot {
  Vec3<T> from;      // the motion's position
  FrameOf<T> frame;  // frame at the root
};

/// The frame of a strand of edges at its root, and its motion, in axes as those of the
/// edges.
template <class T>
struct LaneClamp {
  FrameOf<T> frame;  // frame at the root
  Vec3<T> v, omega;  // velocity and angular velocity
};

}  // namespace tress::models
