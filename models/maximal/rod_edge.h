#pragma once

#include <cmath>

#include "contract/layers.h"
#include "math/frame.h"
#include "math/pack.h"

namespace tress::models {

/// Material frame of the edge e (m) of a discrete rod at angle theta from its reference
/// direction. With a = reference.e0 and t = e/|e|, the reference is turned by the minimal
/// rotation from a to t [Bergou 2010], then by theta about t. Not defined for t = -a.
template <class T>
FrameOf<T> edge_frame(const Frame& reference, const Vec3<T>& e, const T& theta) {
  using std::cos;
  using std::sin;
  using std::sqrt;
  const Vec3<T> a(reference.e0), d1(reference.e1), d2(reference.e2);
  const Vec3<T> t = (T(1) / sqrt(dot(e, e))) * e;
  const Vec3<T> u = cos(theta) * d1 + sin(theta) * d2;
  const Vec3<T> m1 = u - (dot(u, t) / (T(1) + dot(a, t))) * (a + t);
  return {t, m1, cross(t, m1)};
}

/// Rotation of the frame of an edge due to a change of its four coordinates
/// y = (e, theta):
///
///     w(dy) = t x de/L + t (dtheta + c . de),    c = t x a/(L (1 + a . t)),
///
/// where c accounts for the turn about t that the minimal rotation of the reference
/// leaves (the area that t sweeps on the sphere, seen from a). To second order the frame
/// turns by w(dy) + Q(dy, dy)/2.
struct EdgeTurn {
  EdgeTurn() = default;
  /// Evaluates the rotation for an edge vector.
  EdgeTurn(const Vec& reference_tangent, const Vec& e)
      : a(reference_tangent),
        length(norm(e)),
        t((1 / length) * e),
        c((1 / (length * (1 + dot(a, t)))) * cross(t, a)) {}

  /// w for changes or rates of e and theta.
  Vec spin(const Vec& de, double dtheta) const {
    return (1 / length) * cross(t, de) + (dtheta + dot(c, de)) * t;
  }
  /// The force on e that is work-conjugate to a moment: moment . w = force . de + torque
  /// dtheta, torque = moment . t.
  Vec force(const Vec& moment) const {
    return (1 / length) * cross(moment, t) + dot(moment, t) * c;
  }
  /// Column k of w as a matrix (3 x 4).
  Vec column(int k) const {
    if (k == 3) return t;
    const Vec axis{k == 0 ? 1.0 : 0, k == 1 ? 1.0 : 0, k == 2 ? 1.0 : 0};
    return spin(axis, 0);
  }
  /// h += factor moment . Q as a symmetric matrix (4 x 4), one pack per row.
  void add_second(double factor, const Vec& moment, Pack (&h)[4]) const {
    const double along = dot(moment, t);
    const Vec across = (1 / length) * (moment - along * t);
    const double at = dot(a, t);
    const Vec stretch = (2 / length) * t + (1 / (length * (1 + at))) * (a - at * t);
    const auto add = [&](double f, const Vec& x, const Vec& y) {
      const Pack u(x.x, x.y, x.z, 0), w(y.x, y.y, y.z, 0);
      const Vec half_x = 0.5 * f * x, half_y = 0.5 * f * y;
      h[0] += half_x.x * w + half_y.x * u;
      h[1] += half_x.y * w + half_y.y * u;
      h[2] += half_x.z * w + half_y.z * u;
    };
    add(-2 * factor / (length * length), t, cross(moment, t));
    add(factor, across, c);
    add(-factor * along, c, stretch);
    const Vec half = 0.5 * factor * across;
    h[0] += Pack(0, 0, 0, half.x);
    h[1] += Pack(0, 0, 0, half.y);
    h[2] += Pack(0, 0, 0, half.z);
    h[3] += Pack(half.x, half.y, half.z, 0);
  }

  Vec a;              // reference tangent
  double length = 1;  // length of the edge, m
  Vec t{1, 0, 0};     // tangent
  Vec c;              // vector c of the formula
};

/// Renews the reference of an edge that has turned by more than 60 degrees from it. Takes
/// the current frame as the new reference and adds to theta' the turning of the old one,
/// so that neither the frame nor its spin jumps. Returns false if nothing changed.
inline bool renew_reference(Frame& reference, const Vec& e, const Vec& de, double& theta,
                            double& theta_rate) {
  constexpr double far_turned = 0.5;  // cosine
  const EdgeTurn turn(reference.e0, e);
  if (dot(turn.a, turn.t) >= far_turned) return false;
  theta_rate += dot(turn.c, de);
  reference = edge_frame(reference, e, theta);
  theta = 0;
  return true;
}

}  // namespace tress::models
