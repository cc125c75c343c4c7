#pragma once

#include <span>

#include "math/frame.h"

namespace tress::models {

/// x -> to + turn * (x - from).
struct RigidMotion {
  Frame turn;    // rotation
  Vec from, to;  // centre before and after

  /// Returns the place that is moved to x.
  template <class T>
  Vec3<T> back(const Vec3<T>& x) const {
    const Vec3<T> d = x - Vec3<T>(to);
    return Vec3<T>(from) + Vec3<T>{turn.e0.x * d.x + turn.e0.y * d.y + turn.e0.z * d.z,
                                   turn.e1.x * d.x + turn.e1.y * d.y + turn.e1.z * d.z,
                                   turn.e2.x * d.x + turn.e2.y * d.y + turn.e2.z * d.z};
  }
};

/// Computes the rigid motion that takes points `before` to `now` with the least sum of
/// squared distances. The rotation is the polar factor of sum (now - mean)(before -
/// mean)^T, by Newton's iteration [Higham 1986]. Returns no motion where points lie on a
/// line, which does not determine it, or are not finite.
RigidMotion rigid_motion(std::span<const Vec> before, std::span<const Vec> now);

}  // namespace tress::models
