#pragma once

#include "math/frame.h"
#include "math/vec3.h"

namespace tress::models {

/// A rotation exp([phi]x) and its differential, over any scalar. With s = |phi|^2:
///
///     exp([phi]x) = 1 + A [phi]x + B [phi]x^2,      omega = W phi',
///     W = 1 + B [phi]x + C [phi]x^2,
///     A = sum_k (-s)^k/(2k + 1)!,  B = sum_k (-s)^k/(2k + 2)!,  C = sum_k (-s)^k/(2k +
///     3)!
///
/// omega has the components of the outer frame, W^T phi' those of the turned one. The
/// series are accurate to rounding up to a turn of 4 rad, and have no branch at 0.
template <class T>
class RotationChart {
 public:
  /// Takes the rotation vector phi.
  explicit RotationChart(const Vec3<T>& phi)
      : phi_(phi), s_(dot(phi, phi)), a_(series(1)), b_(series(2)), c_(series(3)) {}

  /// Returns the vector x, turned.
  Vec3<T> turned(const Vec3<T>& x) const { return combined(x, a_, b_); }
  /// Returns the rotation.
  FrameOf<T> frame() const {
    const T o(0), one(1);
    return {turned({one, o, o}), turned({o, one, o}), turned({o, o, one})};
  }
  /// Returns W x.
  Vec3<T> w(const Vec3<T>& x) const { return combined(x, b_, c_); }
  /// Returns W^T x.
  Vec3<T> w_transposed(const Vec3<T>& x) const { return combined(x, -b_, c_); }
  /// Returns W' rate, where phi' = rate.
  Vec3<T> w_rate(const Vec3<T>& rate) const { return changed(rate, T(1)); }
  /// Returns (W^T)' rate, where phi' = rate.
  Vec3<T> w_transposed_rate(const Vec3<T>& rate) const { return changed(rate, T(-1)); }

 private:
  static constexpr int terms = 18;

  Vec3<T> combined(const Vec3<T>& x, const T& first, const T& second) const {
    const Vec3<T> once = cross(phi_, x);
    return x + first * once + second * cross(phi_, once);
  }
  Vec3<T> changed(const Vec3<T>& rate, const T& sign) const {
    const T s_rate = T(2) * dot(phi_, rate);
    const Vec3<T> once = cross(phi_, rate);
    return (sign * series_slope(2) * s_rate) * once +
           (series_slope(3) * s_rate) * cross(phi_, once) + c_ * cross(rate, once);
  }
  /// sum_k (-s)^k/(2k + first)! by Horner's rule, without 1/first!.
  T series(int first) const {
    T sum(1);
    for (int k = terms; k > 0; --k) {
      sum = T(1) - (1.0 / ((2 * k + first) * (2 * k + first - 1))) * (s_ * sum);
    }
    return (first == 3 ? 1.0 / 6 : first == 2 ? 0.5 : 1.0) * sum;
  }
  /// Derivative of series(first) by s.
  T series_slope(int first) const {
    T sum(1), slope(0);
    for (int k = terms; k > 0; --k) {
      const double part = 1.0 / ((2 * k + first) * (2 * k + first - 1));
      slope = -part * (sum + s_ * slope);
      sum = T(1) - part * (s_ * sum);
    }
    return (first == 3 ? 1.0 / 6 : first == 2 ? 0.5 : 1.0) * slope;
  }

  Vec3<T> phi_;
  T s_, a_, b_, c_;
};

}  // namespace tress::models
