#pragma once

#include "math/frame.h"
#include "math/lane_math.h"
#include "models/head/matrix3.h"

namespace tress::models {

/// A symmetric form of two turns.
template <class T>
struct TurnForm {
  T xx{}, xy{}, yy{};
};

/// Of 2 t0 x t1/(1 + t0 . t1), t1 the edge's, its derivative by a turn of one of both
/// edges that moves its end along m.
template <class T>
struct SpringBinormal {
  using Vec = Vec3<T>;

  SpringBinormal(const Vec& before, const Vec& after)
      : t0(before),
        t1(after),
        by(T(1) / (T(1) + dot(t0, t1))),
        value((T(2) * by) * cross(t0, t1)) {}
  Vec by_before(const Vec& m) const {
    return (T(2) * by) * cross(m, t1) - (by * dot(m, t1)) * value;
  }
  Vec by_after(const Vec& m) const {
    return (T(2) * by) * cross(t0, m) - (by * dot(t0, m)) * value;
  }
  Vec t0, t1;
  T by;
  Vec value;
};

/// Strains s of a joint do not change with the lengths of its edges. So a turn by m
/// counts less, the longer the edge,
///
///     d^2s/(dt dm) = -(ds/dm)/length,    d^2s/dt^2 = 0,
///
/// and s' has this derivative by a change of an edge (along t, m1, m2), as far as it
/// comes from the edge's own rate, in its frame; g: ds/dm, `second`: that of both m.
template <class T>
Vec3<T> rate_by_own(const T (&g)[2], const TurnForm<T>& second, const T& inverse_length,
                    const Vec3<T>& rate) {
  const T longer = inverse_length * rate.x;
  return {-(inverse_length * (g[0] * rate.y + g[1] * rate.z)),
          second.xx * rate.y + second.xy * rate.z - longer * g[0],
          second.xy * rate.y + second.yy * rate.z - longer * g[1]};
}

/// Second derivative of d . kb by turns k, l of one edge, of the binormal kb and a fixed
/// d, with the first derivatives g and c = by (t of the other edge . m)/length:
///
///     -(c_k g_l + c_l g_k) - delta_kl by d.kb/length^2.
///
/// `straight`: the last term without its sign.
template <class T>
TurnForm<T> second_by_one(const T (&c)[2], const T (&g)[2], const T& straight) {
  return {T(-2) * c[0] * g[0] - straight, -(c[0] * g[1] + c[1] * g[0]),
          T(-2) * c[1] * g[1] - straight};
}

/// Derivatives of a joint's moments by changes of an edge: with the weights of the strain
/// and of its rate,
///
///     k ds/dm ds/dy + stress d^2s/(dm dy) + friction ds/dm d(s')/dy.
template <class T>
struct SpringMoment {
  T k, stress, friction;

  /// A row, of the moment by g; `own`: derivatives of s by the edge's turns.
  Vec3<T> row(const T& g, const T (&own)[2], const T& second1, const T& second2,
              const Vec3<T>& of_rate) const {
    const T rubbed = friction * g;
    return {rubbed * of_rate.x, stress * second1 + g * (k * own[0]) + rubbed * of_rate.y,
            stress * second2 + g * (k * own[1]) + rubbed * of_rate.z};
  }
};

}  // namespace tress::models
