#pragma once

#include "contract/system.h"
#include "math/frame.h"
#include "math/instructions.h"
#include "math/lane_math.h"
#include "math/lanes.h"
#include "models/head/lane_energies.h"
#include "models/head/lane_root.h"
#include "models/head/maximal/der_algebra.h"
#include "models/head/point_loads.h"
#include "models/maximal/spring_strain.h"

namespace tress::models {

/// What the edges of a strand have in common, in consistent units.
template <class T>
struct SpringMaterial {
  T length;    // of an edge
  T mass;      // of an edge
  T drag;      // force on an edge per velocity
  T stretch;   // force per lengthening of an edge
  T bending;   // moment per strain of a joint; the wall's has twice that
  T friction;  // moment per rate of strain, likewise
};

/// Strain at rest of the joint before an edge; of the wall, about its axes e1 and e2.
template <class T>
struct SpringEdge {
  T rest, about_e2;

  static constexpr std::size_t kept = 0;  // what steps change, of a lane
  void keep(int /*lane*/, double* /*to*/) const {}
  void recall(int /*lane*/, const double* /*from*/) {}
};

/// What effects do to the node at an edge's end.
template <class T>
struct NodeLoad {
  PointLoad<T> load;
  T some;  // 1 in lanes with a load, 0 in others
};

/// The strand of point masses and springs of models/maximal/mass_spring.cpp (clamped,
/// edges of equal length, bending = angular, torsion = none, tangent = filtered) for as
/// many strands as T has lanes: Newton's step
///
///     correction = S(w)^-1 r(q, v, a)
///
/// in O(edges). Coordinates: of every edge the vector along it, in axes that do not turn;
/// rates the same, but the first edge's are those of its end.
///
/// A change of an edge is a lengthening and a turn, y = (along t, m1, m2). Springs know
/// edges, masses know nodes x. So everything beyond an edge is, after elimination, a
/// quadratic form of the change of its start and of the turn of the edge before,
///
///     x.A x/2 + x.C y + y.D y/2 - f.x - g.y,
///
/// 3 + 2 unknowns, where banded elimination over nodes keeps 6. The stiffness along an
/// edge, 1e5 times the others, enters one pivot and no sum.
template <class T>
class SpringStrand {
 public:
  using Vec = Vec3<T>;

  static constexpr int per_element = 3;

  /// A symmetric form of two turns.
  struct Form {
    T xx{}, xy{}, yy{};
  };
  /// Of an edge, between sweeps.
  struct Placed {
    FrameOf<T> frame;  // t, m1, m2
    T inverse_length;
    Vec rate;         // of the edge, seen from the root
    Vec force;        // residual of the node at its end, springs left out
    Vec own;          // of the springs, by its change
    T along, across;  // stiffness against it: by stretching
    Form before,
        after;      // of the joint before it: by the turns of the edge before and its
    T mixed[2][2];  // [before][after]
  };
  struct Factor {
    Vec along, one, two;  // A Y + C: forces by changes of the edge
    T by_along, w1, w2;   // pivots, and what is left of the turns
    Form turns;
    Vec own;
  };

  SpringStrand(int edges, const Vec& gravity) : n_(edges), gravity_(gravity) {}

  /// correction = S^-1 r at (q, v, a), with the loads of effects on the ends of edges, or
  /// null. Returns 0, NaN in lanes where it is not finite.
  TRESS_FLATTEN T newton(const SpringMaterial<T>& m, const SpringEdge<T>* edges,
                         const LaneClamp<T>& clamp, Weights w, const T* q, const T* v,
                         const T* a, const NodeLoad<T>* loads, T* correction,
                         Placed* placed, Factor* factors) const {
    place(m, edges, clamp, w, q, v, a, loads, placed);
    eliminate(m, w, loads, placed, factors);
    return substitute(placed, factors, correction);
  }

  /// At (q, v); `at`: of the root, seen from the head's position.
  TRESS_FLATTEN LaneEnergies<T> energies(const SpringMaterial<T>& m,
                                         const SpringEdge<T>* edges,
                                         const LaneClamp<T>& clamp, Vec at, const T* q,
                                         const T* v) const {
    const auto moves = [&](const T& mass, const Vec& u) {
      return T(0.5) * mass * dot(u, u);
    };
    const T end = T(0.5) * m.mass;
    LaneEnergies<T> sum{moves(end, clamp.v), T(0), end * at, dot(clamp.v, clamp.v), at};
    Vec node_v{}, before = clamp.frame.e0;
    for (int i = 0; i < n_; ++i) {
      const Vec edge = load3(q + 3 * i);
      node_v = node_v + load3(v + 3 * i);
      at = at + edge;
      const Vec t = inverse_sqrt(dot(edge, edge)) * edge;
      const T mass = i + 1 < n_ ? m.mass : end;
      sum.kinetic += moves(mass, node_v);
      sum.first = sum.first + mass * at;
      sum.passes(node_v);
      const T longer = dot(edge, t) - m.length;
      sum.elastic += T(0.5) * m.stretch * longer * longer;
      const Vec kb = (T(2) / (T(1) + dot(before, t))) * cross(before, t);
      if (i == 0) {
        const T one = dot(clamp.frame.e1, kb) - edges[0].rest,
                two = dot(clamp.frame.e2, kb) - edges[0].about_e2;
        sum.elastic += m.bending * (one * one + two * two);
      } else {
        const T strain = square_root(dot(kb, kb) + delta_squared()) - edges[i].rest;
        sum.elastic += T(0.5) * m.bending * strain * strain;
      }
      before = t;
    }
    sum.tip = at;
    return sum;
  }

 private:
  static T delta_squared() { return T(Hinge::delta * Hinge::delta); }

  /// Two directions across t [Duff et al. 2017, Building an Orthonormal Basis,
  /// Revisited].
  static FrameOf<T> beside(const Vec& t) {
    const T one(1), sign = where_less(t.z, T(0), -one, one);
    const T a = -one / (sign + t.z), b = t.x * t.y * a;
    return {t,
            {one + sign * t.x * t.x * a, sign * b, -(sign * t.x)},
            {b, sign + t.y * t.y * a, -t.y}};
  }

  void place(const SpringMaterial<T>& m, const SpringEdge<T>* edges,
             const LaneClamp<T>& clamp, Weights w, const T* q, const T* v, const T* a,
             const NodeLoad<T>* loads, Placed* placed) const {
    const T pos(w.pos);
    Vec node_v{}, node_a{};
    for (int i = 0; i < n_; ++i) {
      Placed& e = placed[i];
      const Vec edge = load3(q + 3 * i), given = load3(v + 3 * i);
      node_v = node_v + given;
      node_a = node_a + load3(a + 3 * i);
      e.rate = i == 0 ? given - clamp.v : given;
      const T square = dot(edge, edge);
      e.inverse_length = inverse_sqrt(square);
      e.frame = beside(e.inverse_length * edge);
      e.own = {m.stretch * (square * e.inverse_length - m.length), T(0), T(0)};
      e.along = pos * m.stretch;
      e.across = e.along * larger(T(0), T(1) - m.length * e.inverse_length);
      const T part(i + 1 < n_ ? 1 : 0.5);
      e.force = part * (m.mass * (node_a - gravity_) + m.drag * node_v);
      if (loads != nullptr) [[unlikely]] {
        e.force = where_less(T(0), loads[i].some, e.force - loads[i].load.force, e.force);
      }
      if (i == 0) {
        wall(m, edges[0], clamp, w, edge, e);
      } else {
        hinge(m, edges[i].rest, w, placed[i - 1], e);
      }
    }
  }

  /// Of 2 t0 x t1/(1 + t0 . t1), t1 the edge's, its derivative by a turn of one of both
  /// edges that moves its end along m.
  struct Binormal {
    Binormal(const Vec& before, const Vec& after)
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

  /// Two springs, on the components of the binormal.
  static void wall(const SpringMaterial<T>& m, const SpringEdge<T>& rest,
                   const LaneClamp<T>& clamp, Weights w, const Vec& edge, Placed& e) {
    const FrameOf<T>& f = e.frame;
    const Binormal kb(clamp.frame.e0, f.e0);
    const Vec slope1 = e.inverse_length * kb.by_after(f.e1),
              slope2 = e.inverse_length * kb.by_after(f.e2);
    const Vec rate = e.rate - cross(clamp.omega, edge);
    const T rate1 = dot(f.e1, rate), rate2 = dot(f.e2, rate);
    const T bending = T(2) * m.bending, friction = T(2) * m.friction;
    const T k = T(w.pos) * bending + T(w.vel) * friction;
    e.after = {};
    const auto add = [&](const Vec& axis, const T& at_rest) {
      const T g1 = dot(axis, slope1), g2 = dot(axis, slope2);
      const T stress = bending * (dot(axis, kb.value) - at_rest) +
                       friction * (g1 * rate1 + g2 * rate2);
      e.own.y += stress * g1;
      e.own.z += stress * g2;
      e.after.xx += k * g1 * g1;
      e.after.xy += k * g1 * g2;
      e.after.yy += k * g2 * g2;
    };
    add(clamp.frame.e1, rest.rest);
    add(clamp.frame.e2, rest.about_e2);
  }

  static void hinge(const SpringMaterial<T>& m, const T& rest, Weights w, Placed& before,
                    Placed& e) {
    const FrameOf<T>&f0 = before.frame, &f1 = e.frame;
    const Binormal kb(f0.e0, f1.e0);
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
  }

  void eliminate(const SpringMaterial<T>& m, Weights w, const NodeLoad<T>* loads,
                 const Placed* placed, Factor* factors) const {
    Symmetric3<T> of_x{};  // A
    Vec f{}, c1{}, c2{};   // f, C
    Form of_y{};           // D
    T g1(0), g2(0);
    for (int i = n_ - 1; i >= 0; --i) {
      const Placed& e = placed[i];
      Factor& factor = factors[i];
      const Vec &t = e.frame.e0, &m1 = e.frame.e1, &m2 = e.frame.e2;
      const T part(i + 1 < n_ ? 1 : 0.5);
      const T mass = part * (T(w.acc) * m.mass + T(w.vel) * m.drag);
      of_x.xx += mass;
      of_x.yy += mass;
      of_x.zz += mass;
      if (loads != nullptr) [[unlikely]] {
        of_x = where_less(T(0), loads[i].some, of_x + loads[i].load.block, of_x);
      }
      f = f + e.force;
      const Vec one = of_x * m1, two = of_x * m2;
      factor.along = of_x * t;
      factor.one = one + c1;
      factor.two = two + c2;
      const T pivot = dot(t, factor.along) + e.along;
      const T mixed1 = dot(t, factor.one), mixed2 = dot(t, factor.two);
      const T xx = dot(m1, one) + T(2) * dot(m1, c1) + of_y.xx + e.across + e.after.xx,
              xy = dot(m1, two) + dot(m1, c2) + dot(m2, c1) + of_y.xy + e.after.xy,
              yy = dot(m2, two) + T(2) * dot(m2, c2) + of_y.yy + e.across + e.after.yy;
      factor.own = {dot(t, f) + e.own.x, dot(m1, f) + g1 + e.own.y,
                    dot(m2, f) + g2 + e.own.z};
      factor.by_along = T(1) / pivot;
      factor.w1 = mixed1 * factor.by_along;
      factor.w2 = mixed2 * factor.by_along;
      const T p = xx - factor.w1 * mixed1, r = xy - factor.w1 * mixed2,
              s = yy - factor.w2 * mixed2;
      const T by = T(1) / (p * s - r * r);
      const Form turns{s * by, -(r * by), p * by};
      factor.turns = turns;
      if (i == 0) break;  // the root does not move
      // What is left of the forces of turns once the length has answered.
      const Vec b1 = factor.one - factor.w1 * factor.along,
                b2 = factor.two - factor.w2 * factor.along;
      const T p1 = factor.own.y - factor.w1 * factor.own.x,
              p2 = factor.own.z - factor.w2 * factor.own.x;
      const auto answer = [&](const T& x, const T& y) {
        return std::array{turns.xx * x + turns.xy * y, turns.xy * x + turns.yy * y};
      };
      const auto own = answer(p1, p2), h1 = answer(e.mixed[0][0], e.mixed[0][1]),
                 h2 = answer(e.mixed[1][0], e.mixed[1][1]);
      f = f - (factor.by_along * factor.own.x) * factor.along - own[0] * b1 - own[1] * b2;
      c1 = Vec{} - h1[0] * b1 - h1[1] * b2;
      c2 = Vec{} - h2[0] * b1 - h2[1] * b2;
      of_y = {e.before.xx - e.mixed[0][0] * h1[0] - e.mixed[0][1] * h1[1],
              e.before.xy - e.mixed[0][0] * h2[0] - e.mixed[0][1] * h2[1],
              e.before.yy - e.mixed[1][0] * h2[0] - e.mixed[1][1] * h2[1]};
      g1 = -(e.mixed[0][0] * own[0] + e.mixed[0][1] * own[1]);
      g2 = -(e.mixed[1][0] * own[0] + e.mixed[1][1] * own[1]);
      add_square(of_x, -factor.by_along, factor.along);
      add_square(of_x, -turns.xx, b1);
      add_square(of_x, -turns.yy, b2);
      add_product(of_x, T(-2) * turns.xy, b1, b2);
    }
  }

  T substitute(const Placed* placed, const Factor* factors, T* correction) const {
    Vec x{};
    T before1(0), before2(0), finite(0);  // the last: 0 or NaN
    for (int i = 0; i < n_; ++i) {
      const Placed& e = placed[i];
      const Factor& factor = factors[i];
      const T along = factor.own.x - dot(factor.along, x);
      T one = factor.own.y - dot(factor.one, x), two = factor.own.z - dot(factor.two, x);
      if (i > 0) {
        one = one - e.mixed[0][0] * before1 - e.mixed[1][0] * before2;
        two = two - e.mixed[0][1] * before1 - e.mixed[1][1] * before2;
      }
      one = one - factor.w1 * along;
      two = two - factor.w2 * along;
      before1 = factor.turns.xx * one + factor.turns.xy * two;
      before2 = factor.turns.xy * one + factor.turns.yy * two;
      const Vec edge =
          (factor.by_along * along - factor.w1 * before1 - factor.w2 * before2) *
              e.frame.e0 +
          before1 * e.frame.e1 + before2 * e.frame.e2;
      store3(edge, correction + 3 * i);
      x = x + edge;
      const T all = x.x + x.y + x.z;
      finite += all - all;
    }
    return finite;
  }

  int n_;
  Vec gravity_;
};

}  // namespace tress::models
