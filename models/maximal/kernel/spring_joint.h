#pragma once

#include "math/frame.h"
#include "math/lane_choice.h"
#include "math/matrix3.h"
#include "math/scalar_math.h"

/// Strains of the springs of a joint and their derivatives, over any scalar: `double` for
/// the System of one strand, packs for strands in SIMD lanes. The joint rotates with its
/// two edges, so derivatives are by turns of these edges, in axes across each.
namespace tress::models {

/// Rounds off the kink of |kb| where a joint is straight (Hinge in spring_strain.h).
inline constexpr double hinge_delta = 1e-6;

/// Direction t of an edge, two axes across it, and the inverse of its length.
template <class T>
struct SpringDirection {
  FrameOf<T> frame;  // t, m1, m2
  T inverse_length;  // 1/|edge|

  /// Points along the edge. Returns its length.
  T point(const Vec3<T>& edge) {
    const T square = dot(edge, edge);
    inverse_length = inverse_sqrt(square);
    frame = beside(inverse_length * edge);
    return square * inverse_length;
  }

 private:
  /// Two directions across t [Duff et al. 2017, Building an Orthonormal Basis,
  /// Revisited].
  static FrameOf<T> beside(const Vec3<T>& t) {
    const T one(1), sign = where_less(t.z, T(0), -one, one);
    const T a = -one / (sign + t.z), b = t.x * t.y * a;
    return {t,
            {one + sign * t.x * t.x * a, sign * b, -(sign * t.x)},
            {b, sign + t.y * t.y * a, -t.y}};
  }
};

/// A symmetric form of two turns.
template <class T>
struct TurnForm {
  T xx{}, xy{}, yy{};  // entries of the form
};

/// Curvature binormal 2 t0 x t1/(1 + t0 . t1), and its derivative by a turn of one edge
/// that moves the end of its direction along m.
template <class T>
struct SpringBinormal {
  /// Vector of these scalars.
  using Vec = Vec3<T>;

  /// Evaluates the binormal of two directions.
  SpringBinormal(const Vec& before, const Vec& after)
      : t0(before),
        t1(after),
        by(T(1) / (T(1) + dot(t0, t1))),
        value((T(2) * by) * cross(t0, t1)) {}
  /// Returns the derivative by a turn of the first edge along m.
  Vec by_before(const Vec& m) const {
    return (T(2) * by) * cross(m, t1) - (by * dot(m, t1)) * value;
  }
  /// Returns the derivative by a turn of the second edge along m.
  Vec by_after(const Vec& m) const {
    return (T(2) * by) * cross(t0, m) - (by * dot(t0, m)) * value;
  }
  Vec t0, t1;  // directions of the edges
  T by;        // 1/(1 + t0 . t1)
  Vec value;   // curvature binormal
};

/// Computes the change of the strain rate s' of a joint by its edge's own rate. Strains s
/// of a joint do not change with the lengths of its edges. The effect of a turn by m
/// falls with the length of the edge,
///
///     d^2s/(dt dm) = -(ds/dm)/length,    d^2s/dt^2 = 0,
///
/// so s' has this derivative by a change of an edge (along t, m1, m2), in its frame. g:
/// ds/dm; `second`: the second derivative by both m.
template <class T>
Vec3<T> rate_by_own(const T (&g)[2], const TurnForm<T>& second, const T& inverse_length,
                    const Vec3<T>& rate) {
  const T longer = inverse_length * rate.x;
  return {-(inverse_length * (g[0] * rate.y + g[1] * rate.z)),
          second.xx * rate.y + second.xy * rate.z - longer * g[0],
          second.xy * rate.y + second.yy * rate.z - longer * g[1]};
}

/// Computes the second derivative of d . kb by turns k, l of one edge, for the binormal
/// kb and a fixed d. With the first derivatives g and c = by (t of the other edge .
/// m)/length it is
///
///     -(c_k g_l + c_l g_k) - delta_kl by d.kb/length^2.
///
/// `straight`: the last term without its sign.
template <class T>
TurnForm<T> second_by_one(const T (&c)[2], const T (&g)[2], const T& straight) {
  return {T(-2) * c[0] * g[0] - straight, -(c[0] * g[1] + c[1] * g[0]),
          T(-2) * c[1] * g[1] - straight};
}

/// The strain |(kb, delta)| of a joint between two edges.
template <class T>
struct SpringHinge {
  /// Vector of these scalars.
  using Vec = Vec3<T>;

  /// Evaluates the strain of two edges.
  SpringHinge(const SpringDirection<T>& edge0, const SpringDirection<T>& edge1)
      : before(edge0),
        after(edge1),
        kb(before.frame.e0, after.frame.e0),
        by_value(T(1) / square_root(dot(kb.value, kb.value) + delta_squared())),
        slope{{before.inverse_length * kb.by_before(before.frame.e1),
               before.inverse_length * kb.by_before(before.frame.e2)},
              {after.inverse_length * kb.by_after(after.frame.e1),
               after.inverse_length * kb.by_after(after.frame.e2)}},
        direction(by_value * kb.value) {
    for (int i = 0; i < 2; ++i) {
      for (int k = 0; k < 2; ++k) g[i][k] = dot(slope[i][k], direction);
    }
  }

  /// Returns the strain.
  T value() const { return (dot(kb.value, kb.value) + delta_squared()) * by_value; }
  /// d kb/dm . d kb/dm of turns k of edge i and l of edge j.
  T metric(int i, int k, int j, int l) const { return dot(slope[i][k], slope[j][l]); }

  /// Second derivatives of a strain by turns.
  struct Second {
    TurnForm<T> by_before, by_after;  // by the turns of one edge
    T mixed[2][2];                    // [before][after]
  };
  /// Computes the second derivative of d . kb with d along kb, and the changes of kb
  /// across d.
  Second second() const {
    const FrameOf<T>&f0 = before.frame, &f1 = after.frame;
    const T by0 = kb.by * before.inverse_length, by1 = kb.by * after.inverse_length;
    const T c[2][2] = {{by0 * dot(kb.t1, f0.e1), by0 * dot(kb.t1, f0.e2)},
                       {by1 * dot(kb.t0, f1.e1), by1 * dot(kb.t0, f1.e2)}};
    const T bent = dot(direction, kb.value);
    const auto across = [&](int i, int k, int j, int l) {
      return by_value * (metric(i, k, j, l) - g[i][k] * g[j][l]);
    };
    const auto alike = [&](int i, const T& straight) {
      const TurnForm<T> form = second_by_one(c[i], g[i], straight);
      return TurnForm<T>{form.xx + across(i, 0, i, 0), form.xy + across(i, 0, i, 1),
                         form.yy + across(i, 1, i, 1)};
    };
    Second all{alike(0, by0 * before.inverse_length * bent),
               alike(1, by1 * after.inverse_length * bent),
               {}};
    const Vec m0[] = {f0.e1, f0.e2}, m1[] = {f1.e1, f1.e2};
    const T both = by0 * after.inverse_length;
    for (int k = 0; k < 2; ++k) {
      for (int l = 0; l < 2; ++l) {
        all.mixed[k][l] = across(0, k, 1, l) - c[1][l] * g[0][k] - c[0][k] * g[1][l] +
                          both * (T(2) * dot(direction, cross(m0[k], m1[l])) -
                                  dot(m0[k], m1[l]) * bent);
      }
    }
    return all;
  }

  /// Returns the square of hinge_delta.
  static T delta_squared() { return T(hinge_delta * hinge_delta); }

  const SpringDirection<T>& before;  // first edge
  const SpringDirection<T>& after;   // second edge
  SpringBinormal<T> kb;              // binormal of the joint
  T by_value;                        // 1/value()
  Vec slope[2][2];                   // of kb, [edge][turn]
  Vec direction;                     // of kb, shorter than 1 by delta
  T g[2][2];                         // of the strain
};

/// Two strains of the joint between a wall and the first edge: components of kb along
/// axes of the wall.
template <class T>
struct SpringWall {
  /// Vector of these scalars.
  using Vec = Vec3<T>;

  /// Evaluates the binormal of a wall and an edge.
  SpringWall(const Vec& tangent, const SpringDirection<T>& edge)
      : after(edge),
        kb(tangent, edge.frame.e0),
        slope{edge.inverse_length * kb.by_after(edge.frame.e1),
              edge.inverse_length * kb.by_after(edge.frame.e2)} {}

  /// One component.
  struct Strain {
    T value, g[2];  // strain, and its derivatives by the edge's turns
  };
  /// Returns the component along an axis of the wall.
  Strain along(const Vec& axis) const {
    return {dot(axis, kb.value), {dot(axis, slope[0]), dot(axis, slope[1])}};
  }
  /// Returns its second derivatives by the edge's turns.
  TurnForm<T> second(const Strain& of) const {
    const T by = kb.by * after.inverse_length;
    const T c[] = {by * dot(kb.t0, after.frame.e1), by * dot(kb.t0, after.frame.e2)};
    return second_by_one(c, of.g, by * after.inverse_length * of.value);
  }

  const SpringDirection<T>& after;  // the first edge
  SpringBinormal<T> kb;             // binormal of the joint
  Vec slope[2];                     // its derivatives by the edge's turns
};

/// Derivatives of a joint's moments by changes of an edge: with the weights of the strain
/// and of its rate,
///
///     k ds/dm ds/dy + stress d^2s/(dm dy) + friction ds/dm d(s')/dy.
template <class T>
struct SpringMoment {
  T k, stress, friction;  // weights

  /// A row, of the moment by g; `own`: derivatives of s by the edge's turns.
  Vec3<T> row(const T& g, const T (&own)[2], const T& second1, const T& second2,
              const Vec3<T>& of_rate) const {
    const T rubbed = friction * g;
    return {rubbed * of_rate.x, stress * second1 + g * (k * own[0]) + rubbed * of_rate.y,
            stress * second2 + g * (k * own[1]) + rubbed * of_rate.z};
  }
};

}  // namespace tress::models
