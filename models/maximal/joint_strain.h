#pragma once

#include <cmath>
#include <numbers>

#include "contract/layers.h"
#include "math/frame.h"
#include "math/pack.h"

namespace tress::models {

/// Bending and twisting between two neighbouring frames (e0 the tangent) of a discrete
/// rod, integrated over the joint (rad): twist, curvature about e1, curvature about e2.
/// With t = e0, - the frame before and + the one behind, c = 1 + t- . t+,
///
///     kappa_1 = -(t+ . e2- - t- . e2+)/c,    kappa_2 = (t+ . e1- - t- . e1+)/c,
///     twist = atan2(e2- . e1+ - e1- . e2+, e1- . e1+ + e2- . e2+).
///
/// These are the strains of [Bergou 2008, 2010]. The curvatures are kb . (e1- + e1+)/2
/// and kb . (e2- + e2+)/2 with the curvature binormal kb = 2 t- x t+/c. The twist is the
/// angle that remains after the minimal rotation of t- to t+. |kappa| = 2 tan(angle/2).
/// Not defined for antiparallel tangents (c = 0).
template <class T>
Vec3<T> joint_strain(const FrameOf<T>& minus, const FrameOf<T>& plus) {
  using std::atan2;
  const T c = T(1) + dot(minus.e0, plus.e0);
  return {atan2(dot(minus.e2, plus.e1) - dot(minus.e1, plus.e2),
                dot(minus.e1, plus.e1) + dot(minus.e2, plus.e2)),
          (dot(minus.e0, plus.e2) - dot(plus.e0, minus.e2)) / c,
          (dot(plus.e0, minus.e1) - dot(minus.e0, plus.e1)) / c};
}

/// Returns the twist with whole turns counted. The frames of a joint determine its twist
/// up to whole turns; the angle nearest to `near`, the twist a short time before, is
/// chosen. A joint that turns on past half a turn is twisted by more, as in [Bergou
/// 2008], where the angles of the edges count the turns. Between -pi and pi its force
/// would jump to the other side there.
inline double wound(double twist, double near) {
  constexpr double turn = 2 * std::numbers::pi;
  return twist + turn * std::round((near - twist) / turn);
}

/// Quadratic form of two vectors, f(u, w) = uu:(u u) + uw:(u w) + ww:(w w). Stored as the
/// symmetric matrix over (u, w): six rows of one pack for u and one for w, whose last
/// lanes are 0.
struct TwoVectorForm {
  Pack rows[6][2] = {};  // rows of the symmetric matrix

  /// Returns an entry.
  double at(int i, int j) const { return rows[i][j / 3][j % 3]; }

  /// += factor ((w - u) . a) (x . b), x = u (side 0) or w (side 1).
  void add(double factor, const Vec& a, int side, const Vec& b) {
    const Vec half_a = 0.5 * factor * a, half_b = 0.5 * factor * b;
    const Pack of_a = pack(a), of_b = pack(b);
    const double from[3] = {half_a.x, half_a.y, half_a.z};
    const double to[3] = {half_b.x, half_b.y, half_b.z};
    for (int i = 0; i < 3; ++i) {
      rows[i][side] -= from[i] * of_b;
      rows[3 + i][side] += from[i] * of_b;
      rows[3 * side + i][0] -= to[i] * of_a;
      rows[3 * side + i][1] += to[i] * of_a;
    }
  }
  /// += factor |w - u|^2.
  void add_square(double factor) {
    add_both(0, pack({factor, 0, 0}));
    add_both(1, pack({0, factor, 0}));
    add_both(2, pack({0, 0, factor}));
  }
  /// Adds factor w . (u x a).
  void add_triple(double factor, const Vec& a) {
    // u x a = -[a]x u
    const Vec h = 0.5 * factor * a;
    const Pack of_h[3] = {pack({0, h.z, -h.y}), pack({-h.z, 0, h.x}),
                          pack({h.y, -h.x, 0})};
    for (int i = 0; i < 3; ++i) {
      rows[3 + i][0] += of_h[i];
      rows[i][1] -= of_h[i];
    }
  }

 private:
  static Pack pack(const Vec& x) { return Pack(x.x, x.y, x.z, 0); }
  /// Row i of a matrix of w - u.
  void add_both(int i, const Pack& row) {
    rows[i][0] += row;
    rows[3 + i][1] += row;
    rows[i][1] -= row;
    rows[3 + i][0] -= row;
  }
};

/// The strains of a joint and their derivatives with respect to rotations exp([w-]x) and
/// exp([w+]x) of the two frames, world components. The first derivatives depend on the
/// relative rotation only: d strain = gradient . (w+ - w-).
struct JointStrain {
  JointStrain() = default;
  /// Evaluates the strains between two frames.
  JointStrain(const Frame& minus, const Frame& plus)
      : c(1 + dot(minus.e0, plus.e0)),
        value(joint_strain(minus, plus)),
        k((1 / c) * cross(minus.e0, plus.e0)),
        twist((1 / c) * (minus.e0 + plus.e0)),
        curvature1((-1 / c) * (cross(minus.e0, plus.e2) + cross(plus.e0, minus.e2)) +
                   value.y * k),
        curvature2((1 / c) * (cross(minus.e0, plus.e1) + cross(plus.e0, minus.e1)) +
                   value.z * k) {}

  /// Sum of stress times second derivative of each strain; the terms of second order in
  /// (w-, w+) are half of this form. With d = w+ - w-,
  /// m = (stress_2 e1 - stress_1 e2)/c on either side, and
  /// s = (stress_1 kappa_1 + stress_2 kappa_2)/c:
  ///
  ///     (d . t-)(w- . (m+ + s t+)) - (d . (m+ + s t+))(w+ . t-) - (d . m-)(w- . t+)
  ///       + (d . t+)(w+ . m-) - s |d|^2 + (d . g)(d . k) + stress_0 w+ . (w- x twist),
  ///
  /// where g sums the gradients of the curvatures, weighted by twice their stresses, and
  /// that of the twist.
  TwoVectorForm second(const Frame& minus, const Frame& plus, const Vec& stress) const {
    TwoVectorForm form;
    const double s2 = stress.z / c, s1 = -stress.y / c;
    const double s = s2 * value.z - s1 * value.y;
    const Vec m_minus = s2 * minus.e1 + s1 * minus.e2;
    const Vec m_plus = s2 * plus.e1 + s1 * plus.e2 + s * plus.e0;
    form.add(1, minus.e0, 0, m_plus);
    form.add(-1, m_plus, 1, minus.e0);
    form.add(-1, m_minus, 0, plus.e0);
    form.add(1, plus.e0, 1, m_minus);
    form.add_square(-s);
    const Vec g =
        2 * stress.y * curvature1 + 2 * stress.z * curvature2 + stress.x * twist;
    form.add(-1, g, 0, k);
    form.add(1, g, 1, k);
    form.add_triple(stress.x, twist);
    return form;
  }

  double c = 2;                       // 1 + product of the tangents
  Vec value;                          // twist and curvatures
  Vec k;                              // half the curvature binormal
  Vec twist, curvature1, curvature2;  // gradients of the three strains
};

}  // namespace tress::models
