#pragma once

#include <type_traits>

#include "contract/system.h"
#include "models/head/lane_root.h"
#include "models/head/maximal/spring_elimination.h"
#include "models/maximal/spring_strain.h"

namespace tress::models {

/// Strain at rest of the joint before an edge; of the wall, about its axes e1 and e2.
template <class T>
struct SpringEdge {
  T rest, about_e2;

  static constexpr std::size_t kept = 0;  // what steps change, of a lane
  void keep(int /*lane*/, double* /*to*/) const {}
  void recall(int /*lane*/, const double* /*from*/) {}
};

/// The springs of a strand's joints at a state: what they add to the residuals of edges
/// and, with_tangent, to the derivatives.
template <class T, bool exact>
class SpringBending {
 public:
  using Vec = Vec3<T>;
  using Placed = std::conditional_t<exact, SpringExactPlaced<T>, SpringStiffPlaced<T>>;

  static T delta_squared() { return T(Hinge::delta * Hinge::delta); }

  /// Two springs, on the components of the binormal.
  template <bool with_tangent>
  static void wall(const SpringMaterial<T>& m, const SpringEdge<T>& rest,
                   const LaneClamp<T>& clamp, Weights w, const Vec& edge, Placed& e) {
    const FrameOf<T>& f = e.frame;
    const SpringBinormal<T> kb(clamp.frame.e0, f.e0);
    const Vec slope1 = e.inverse_length * kb.by_after(f.e1),
              slope2 = e.inverse_length * kb.by_after(f.e2);
    const Vec rate = e.rate - cross(clamp.omega, edge);
    const T rate1 = dot(f.e1, rate), rate2 = dot(f.e2, rate);
    const T bending = T(2) * m.bending, friction = T(2) * m.friction;
    const T k = T(w.pos) * bending + T(w.vel) * friction;
    if constexpr (exact) {
      e.own_by_own = {};
    } else {
      e.after = {};
    }
    const auto add = [&](const Vec& axis, const T& at_rest) {
      const T g[] = {dot(axis, slope1), dot(axis, slope2)}, value = dot(axis, kb.value);
      const T stress =
          bending * (value - at_rest) + friction * (g[0] * rate1 + g[1] * rate2);
      e.own.y += stress * g[0];
      e.own.z += stress * g[1];
      if constexpr (!exact) {
        e.after.xx += k * g[0] * g[0];
        e.after.xy += k * g[0] * g[1];
        e.after.yy += k * g[1] * g[1];
      } else if constexpr (with_tangent) {
        const T by = kb.by * e.inverse_length;
        const T c[] = {by * dot(kb.t0, f.e1), by * dot(kb.t0, f.e2)};
        const auto second = second_by_one(c, g, by * e.inverse_length * value);
        const Vec of_rate =
            rate_by_own(g, second, e.inverse_length, {dot(f.e0, rate), rate1, rate2}) +
            f.back(cross(clamp.omega, g[0] * f.e1 + g[1] * f.e2));
        add_moment({k, T(w.pos) * stress, T(w.pos) * friction}, g, second, of_rate, e);
      }
    };
    add(clamp.frame.e1, rest.rest);
    add(clamp.frame.e2, rest.about_e2);
  }

  template <bool with_tangent>
  static void hinge(const SpringMaterial<T>& m, const T& rest, Weights w, Placed& before,
                    Placed& e) {
    const FrameOf<T>&f0 = before.frame, &f1 = e.frame;
    const SpringBinormal<T> kb(f0.e0, f1.e0);
    const T by_value = T(1) / square_root(dot(kb.value, kb.value) + delta_squared());
    const Vec slope[2][2] = {
        {before.inverse_length * kb.by_before(f0.e1),
         before.inverse_length * kb.by_before(f0.e2)},
        {e.inverse_length * kb.by_after(f1.e1), e.inverse_length * kb.by_after(f1.e2)}};
    const Vec direction = by_value * kb.value;
    T g[2][2];
    for (int i = 0; i < 2; ++i) {
      for (int k = 0; k < 2; ++k) g[i][k] = dot(slope[i][k], direction);
    }
    const T speed = g[0][0] * dot(f0.e1, before.rate) +
                    g[0][1] * dot(f0.e2, before.rate) + g[1][0] * dot(f1.e1, e.rate) +
                    g[1][1] * dot(f1.e2, e.rate);
    const T value = (dot(kb.value, kb.value) + delta_squared()) * by_value;
    const T stress = m.bending * (value - rest) + m.friction * speed;
    before.own.y += stress * g[0][0];
    before.own.z += stress * g[0][1];
    e.own.y += stress * g[1][0];
    e.own.z += stress * g[1][1];
    if constexpr (!exact) {
      // (pos k + vel c) g g^T + across (J^T J - g g^T).
      const T across = T(w.pos) * m.bending * larger(T(0), T(1) - rest * by_value);
      const T along = T(w.pos) * m.bending + T(w.vel) * m.friction - across;
      const auto entry = [&](int i, int k, int j, int l) {
        return along * g[i][k] * g[j][l] + across * dot(slope[i][k], slope[j][l]);
      };
      e.before = {entry(0, 0, 0, 0), entry(0, 0, 0, 1), entry(0, 1, 0, 1)};
      e.after = {entry(1, 0, 1, 0), entry(1, 0, 1, 1), entry(1, 1, 1, 1)};
      for (int k = 0; k < 2; ++k) {
        for (int l = 0; l < 2; ++l) e.mixed[k][l] = entry(0, k, 1, l);
      }
    } else if constexpr (with_tangent) {
      bend(kb, slope, g, by_value,
           {T(w.pos) * m.bending + T(w.vel) * m.friction, T(w.pos) * stress,
            T(w.pos) * m.friction},
           before, e);
    }
  }

 private:
  /// Adds the exact tangent of a hinge, whose strain is the length of (kb, delta): with d
  /// along kb, the second derivative of d . kb, and what kb changes across d.
  static void bend(const SpringBinormal<T>& kb, const Vec (&slope)[2][2],
                   const T (&g)[2][2], const T& by_value, const SpringMoment<T>& weights,
                   Placed& before, Placed& e) {
    const FrameOf<T>&f0 = before.frame, &f1 = e.frame;
    const T by0 = kb.by * before.inverse_length, by1 = kb.by * e.inverse_length;
    const T c[2][2] = {{by0 * dot(kb.t1, f0.e1), by0 * dot(kb.t1, f0.e2)},
                       {by1 * dot(kb.t0, f1.e1), by1 * dot(kb.t0, f1.e2)}};
    const Vec d = by_value * kb.value;
    const T bent = dot(d, kb.value);
    const auto across = [&](int i, int k, int j, int l) {
      return by_value * (dot(slope[i][k], slope[j][l]) - g[i][k] * g[j][l]);
    };
    const auto alike = [&](int i, const T& straight) {
      const TurnForm<T> form = second_by_one(c[i], g[i], straight);
      return TurnForm<T>{form.xx + across(i, 0, i, 0), form.xy + across(i, 0, i, 1),
                         form.yy + across(i, 1, i, 1)};
    };
    const TurnForm<T> second[] = {alike(0, by0 * before.inverse_length * bent),
                                  alike(1, by1 * e.inverse_length * bent)};
    const Vec m0[] = {f0.e1, f0.e2}, m1[] = {f1.e1, f1.e2};
    const T both = by0 * e.inverse_length;
    T mixed[2][2];
    for (int k = 0; k < 2; ++k) {
      for (int l = 0; l < 2; ++l) {
        mixed[k][l] =
            across(0, k, 1, l) - c[1][l] * g[0][k] - c[0][k] * g[1][l] +
            both * (T(2) * dot(d, cross(m0[k], m1[l])) - dot(m0[k], m1[l]) * bent);
      }
    }
    const Vec rate0 = f0.back(before.rate), rate1 = f1.back(e.rate);
    const Vec of_rate0 = rate_by_own(g[0], second[0], before.inverse_length, rate0) +
                         Vec{T(0), mixed[0][0] * rate1.y + mixed[0][1] * rate1.z,
                             mixed[1][0] * rate1.y + mixed[1][1] * rate1.z};
    const Vec of_rate1 = rate_by_own(g[1], second[1], e.inverse_length, rate1) +
                         Vec{T(0), mixed[0][0] * rate0.y + mixed[1][0] * rate0.z,
                             mixed[0][1] * rate0.y + mixed[1][1] * rate0.z};
    add_moment(weights, g[0], second[0], of_rate0, before);
    e.own_by_own = {};
    add_moment(weights, g[1], second[1], of_rate1, e);
    for (int k = 0; k < 2; ++k) {
      e.on_before[k] = weights.row(g[0][k], g[1], mixed[k][0], mixed[k][1], of_rate1);
      e.by_before[k] = weights.row(g[1][k], g[0], mixed[0][k], mixed[1][k], of_rate0);
    }
  }
  static void add_moment(const SpringMoment<T>& weights, const T (&g)[2],
                         const TurnForm<T>& second, const Vec& of_rate, Placed& e) {
    Vec* const row = e.own_by_own.row;
    row[1] = row[1] + weights.row(g[0], g, second.xx, second.xy, of_rate);
    row[2] = row[2] + weights.row(g[1], g, second.xy, second.yy, of_rate);
  }
};

}  // namespace tress::models
