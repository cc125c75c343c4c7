#pragma once

#include "math/frame.h"

namespace tress::models {

/// Where a strand's root is in the head at rest.
template <class T>
struct LaneRoot {
  Vec3<T> from;  // the motion's position
  FrameOf<T> frame;
};

}  // namespace tress::models
