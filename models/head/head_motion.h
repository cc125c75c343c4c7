#pragma once

#include "models/head/lane_root.h"
#include "models/head/reduced_kernel.h"

namespace tress::models {

/// Motion of a head in its own components and units; gravity g is a part of a.
struct HeadMotion {
  Vec v, omega;  // velocity, angular velocity
  Vec a, alpha;  // acceleration minus g, angular acceleration
};

/// Returns the motion of roots that are fixed to the head.
template <class T>
[[gnu::always_inline]] inline ReducedMotion<T> root_motion(const LaneRoot<T>& root,
                                                           const HeadMotion& head) {
  const Vec3<T> omega(head.omega), alpha(head.alpha);
  const Vec3<T> v = Vec3<T>(head.v) + cross(omega, root.from);
  const Vec3<T> a =
      Vec3<T>(head.a) + cross(alpha, root.from) + cross(omega, cross(omega, root.from));
  return {root.frame.back(v), root.frame.back(omega), root.frame.back(a),
          root.frame.back(alpha)};
}

}  // namespace tress::models
