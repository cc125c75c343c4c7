#pragma once

#include <cmath>

#include "math/vec3.h"

namespace tress {

/// A rotation, stored as the three axes of a frame in components of the outer frame:
/// `frame * x` maps components in the frame to outer components.
template <class T>
struct FrameOf {
  /// First axis; the tangent in frames of rods.
  Vec3<T> e0{T(1), T(0), T(0)};
  /// Second axis.
  Vec3<T> e1{T(0), T(1), T(0)};
  /// Third axis.
  Vec3<T> e2{T(0), T(0), T(1)};

  [[gnu::always_inline]] friend constexpr Vec3<T> operator*(const FrameOf& f,
                                                            const Vec3<T>& x) {
    return x.x * f.e0 + x.y * f.e1 + x.z * f.e2;
  }
  [[gnu::always_inline]] friend constexpr FrameOf operator*(const FrameOf& f,
                                                            const FrameOf& g) {
    return {f * g.e0, f * g.e1, f * g.e2};
  }
  /// Applies the transpose: outer components to components in the frame.
  [[gnu::always_inline]] constexpr Vec3<T> back(const Vec3<T>& x) const {
    return {dot(e0, x), dot(e1, x), dot(e2, x)};
  }
};

/// Rotation of numbers in double precision.
using Frame = FrameOf<double>;

/// Turns by `angle` (rad) about `axis`, whose length must be 1 (Rodrigues).
inline Frame rotation(const Vec& axis, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  const auto turn = [&](const Vec& e) {
    return c * e + s * cross(axis, e) + ((1 - c) * dot(axis, e)) * axis;
  };
  return {turn({1, 0, 0}), turn({0, 1, 0}), turn({0, 0, 1})};
}

/// Stores the nine numbers axis by axis.
inline void store9(const Frame& f, double* p) {
  store3(f.e0, p);
  store3(f.e1, p + 3);
  store3(f.e2, p + 6);
}
/// Reads a frame from nine numbers, axis by axis.
inline Frame load9(const double* p) { return {load3(p), load3(p + 3), load3(p + 6)}; }

/// Whether the axes have length 1, are orthogonal (both to 1e-12, false on NaN) and
/// right-handed.
bool is_rotation(const Frame& frame);

}  // namespace tress
