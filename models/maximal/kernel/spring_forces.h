#pragma once

#include <type_traits>

#include "contract/basics.h"
#include "models/maximal/kernel/spring_elimination.h"

namespace tress::models {

/// Spring of a joint: stiffness k and friction c of its strain.
template <class T>
struct SpringStiffness {
  T bending;   // moment per strain
  T friction;  // moment per rate of strain
};

/// The springs of a strand at a state: residuals of edges and, with_tangent, derivatives.
/// Edge by edge from the root on, stretch() comes first, then the joint before the edge:
/// wall() or hinge(), which adds to the edge before, too.
template <class T, bool exact>
class SpringForces {
 public:
  /// Vector of these scalars.
  using Vec = Vec3<T>;
  /// Geometry and stresses at a state.
  using Placed = std::conditional_t<exact, SpringExactPlaced<T>, SpringStiffPlaced<T>>;

  /// Begins an edge: its direction, and its spring.
  static void stretch(const T& stiffness, const T& length, Weights w, const Vec& edge,
                      const Vec& rate, Placed& e) {
    e.rate = rate;
    e.own = {stiffness * (e.point(edge) - length), T(0), T(0)};
    if constexpr (!exact) {
      e.along = T(w.pos) * stiffness;
      e.across = e.along * larger(T(0), T(1) - length * e.inverse_length);
    }
  }

  /// Two springs, on the components of the binormal along the wall's axes e1 and e2;
  /// `rest`, `rest2`: their strains at rest. The wall turns by omega.
  template <bool with_tangent>
  static void wall(const SpringStiffness<T>& m, const T& rest, const T& rest2,
                   const FrameOf<T>& clamp, const Vec& omega, Weights w, const Vec& edge,
                   Placed& e) {
    const FrameOf<T>& f = e.frame;
    const SpringWall<T> joint(clamp.e0, e);
    const Vec rate = e.rate - cross(omega, edge);
    const T rate1 = dot(f.e1, rate), rate2 = dot(f.e2, rate);
    const T k = T(w.pos) * m.bending + T(w.vel) * m.friction;
    if constexpr (exact) {
      e.own_by_own = {};
    } else {
      e.after = {};
    }
    const auto add = [&](const Vec& axis, const T& at_rest) {
      const typename SpringWall<T>::Strain s = joint.along(axis);
      const T(&g)[2] = s.g;
      const T stress =
          m.bending * (s.value - at_rest) + m.friction * (g[0] * rate1 + g[1] * rate2);
      e.own.y += stress * g[0];
      e.own.z += stress * g[1];
      if constexpr (!with_tangent) return;
      if constexpr (!exact) {
        e.after.xx += k * g[0] * g[0];
        e.after.xy += k * g[0] * g[1];
        e.after.yy += k * g[1] * g[1];
      } else {
        const TurnForm<T> second = joint.second(s);
        const Vec of_rate =
            rate_by_own(g, second, e.inverse_length, {dot(f.e0, rate), rate1, rate2}) +
            f.back(cross(omega, g[0] * f.e1 + g[1] * f.e2));
        add_moment({k, T(w.pos) * stress, T(w.pos) * m.friction}, g, second, of_rate, e);
      }
    };
    add(clamp.e1, rest);
    add(clamp.e2, rest2);
  }

  /// Adds the spring of the joint between two edges.
  template <bool with_tangent>
  static void hinge(const SpringStiffness<T>& m, const T& rest, Weights w, Placed& before,
                    Placed& e) {
    const FrameOf<T>&f0 = before.frame, &f1 = e.frame;
    const SpringHinge<T> joint(before, e);
    const T(&g)[2][2] = joint.g;
    const T speed = g[0][0] * dot(f0.e1, before.rate) +
                    g[0][1] * dot(f0.e2, before.rate) + g[1][0] * dot(f1.e1, e.rate) +
                    g[1][1] * dot(f1.e2, e.rate);
    const T stress = m.bending * (joint.value() - rest) + m.friction * speed;
    before.own.y += stress * g[0][0];
    before.own.z += stress * g[0][1];
    e.own.y += stress * g[1][0];
    e.own.z += stress * g[1][1];
    if constexpr (!with_tangent) return;
    if constexpr (!exact) {
      // (pos k + vel c) g g^T + across (J^T J - g g^T).
      const T across = T(w.pos) * m.bending * larger(T(0), T(1) - rest * joint.by_value);
      const T along = T(w.pos) * m.bending + T(w.vel) * m.friction - across;
      const auto entry = [&](int i, int k, int j, int l) {
        return along * g[i][k] * g[j][l] + across * joint.metric(i, k, j, l);
      };
      e.before = {entry(0, 0, 0, 0), entry(0, 0, 0, 1), entry(0, 1, 0, 1)};
      e.after = {entry(1, 0, 1, 0), entry(1, 0, 1, 1), entry(1, 1, 1, 1)};
      for (int k = 0; k < 2; ++k) {
        for (int l = 0; l < 2; ++l) e.mixed[k][l] = entry(0, k, 1, l);
      }
    } else {
      bend(joint,
           {T(w.pos) * m.bending + T(w.vel) * m.friction, T(w.pos) * stress,
            T(w.pos) * m.friction},
           before, e);
    }
  }

 private:
  /// Adds the exact tangent of a hinge.
  static void bend(const SpringHinge<T>& joint, const SpringMoment<T>& weights,
                   Placed& before, Placed& e) {
    const T(&g)[2][2] = joint.g;
    const auto second = joint.second();
    const T(&mixed)[2][2] = second.mixed;
    const Vec rate0 = before.frame.back(before.rate), rate1 = e.frame.back(e.rate);
    const Vec of_rate0 =
        rate_by_own(g[0], second.by_before, before.inverse_length, rate0) +
        Vec{T(0), mixed[0][0] * rate1.y + mixed[0][1] * rate1.z,
            mixed[1][0] * rate1.y + mixed[1][1] * rate1.z};
    const Vec of_rate1 = rate_by_own(g[1], second.by_after, e.inverse_length, rate1) +
                         Vec{T(0), mixed[0][0] * rate0.y + mixed[1][0] * rate0.z,
                             mixed[0][1] * rate0.y + mixed[1][1] * rate0.z};
    add_moment(weights, g[0], second.by_before, of_rate0, before);
    e.own_by_own = {};
    add_moment(weights, g[1], second.by_after, of_rate1, e);
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
