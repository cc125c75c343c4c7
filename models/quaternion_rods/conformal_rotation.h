#pragma once

#include "math/quaternion.h"

namespace tress::models {

/// Unit quaternion p of a conformal rotation vector c, whose length is 4 tan(angle/4) and
/// which lies along the axis [Milenkovic 1982]:
///
///     p = (1 - s.s, 2 s)/(1 + s.s),    s = c/4.
///
/// It is the rotation vector up to terms of third order. Every c is a rotation by less
/// than a turn. dp/dc has orthogonal columns of one length, scale().
class ConformalRotation {
 public:
  /// Constructs the rotation of a vector.
  explicit ConformalRotation(const Vec& c = {})
      : s_(0.25 * c), f_(1 / (1 + dot(s_, s_))) {}
  /// Returns the vector of a unit quaternion with w > -1.
  static Vec vector(const Quaternion& p) { return (4 / (1 + p.w)) * p.v; }

  /// Returns the unit quaternion p.
  Quaternion value() const { return {2 * f_ - 1, 2 * f_ * s_}; }
  /// Returns the length of the derivative of p along a unit vector.
  double scale() const { return f_ / 2; }
  /// Returns the derivative of p along x.
  Quaternion slope(const Vec& x) const {
    const Vec u = 0.25 * x;
    return around(first(u), f_ * u);
  }
  /// Returns the second derivative of p along x and y.
  Quaternion second(const Vec& x, const Vec& y) const {
    const Vec u = 0.25 * x, w = 0.25 * y;
    return around(second_of_f(u, w), first(u) * w + first(w) * u);
  }
  /// Returns the third derivative of p along x, x and y.
  Quaternion third(const Vec& x, const Vec& y) const {
    const Vec u = 0.25 * x, w = 0.25 * y;
    const double su = dot(s_, u), sw = dot(s_, w), cube = f_ * f_ * f_;
    const double of_f =
        8 * cube * (dot(u, u) * sw + 2 * dot(u, w) * su) - 48 * cube * f_ * su * su * sw;
    return around(of_f, second_of_f(u, u) * w + 2 * second_of_f(u, w) * u);
  }
  /// h += factor times the second derivatives of x.p by c.
  void add_second(const Quaternion& x, double factor, double (&h)[3][3]) const {
    const double part = factor * f_ * f_ / 4, along = x.w + dot(s_, x.v);
    double s[3], v[3];
    store3(s_, s);
    store3(x.v, v);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        h[i][j] += part * (4 * f_ * along * s[i] * s[j] - s[i] * v[j] - v[i] * s[j]);
      }
      h[i][i] -= part * along;
    }
  }
  /// Returns (dp/dc)^T x.
  Vec pull_back(const Quaternion& x) const {
    return (f_ / 2) * (x.v - (2 * f_ * (x.w + dot(s_, x.v))) * s_);
  }
  /// Returns the y for which slope(y) is x, or x without its part along p.
  Vec rate(const Quaternion& x) const { return (1 / (scale() * scale())) * pull_back(x); }

 private:
  // Derivatives of f = 1/(1 + s.s), along s.
  double first(const Vec& u) const { return -2 * f_ * f_ * dot(s_, u); }
  double second_of_f(const Vec& u, const Vec& w) const {
    return 2 * f_ * f_ * (4 * f_ * dot(s_, u) * dot(s_, w) - dot(u, w));
  }
  /// Returns a derivative of p = (2 f - 1, 2 f s) from `of_f`, that of f, and `rest`,
  /// that of f s at fixed derivative of f.
  Quaternion around(double of_f, const Vec& rest) const {
    return {2 * of_f, 2.0 * (of_f * s_ + rest)};
  }

  Vec s_;
  double f_;
};

}  // namespace tress::models
