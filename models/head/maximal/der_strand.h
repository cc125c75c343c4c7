#pragma once

#include <type_traits>

#include "contract/basics.h"
#include "math/frame.h"
#include "math/instructions.h"
#include "math/lane_math.h"
#include "math/lanes.h"
#include "models/head/lane_energies.h"
#include "models/head/lane_root.h"
#include "models/head/maximal/edge_loads.h"
#include "models/maximal/kernel/der_forces.h"

namespace tress::models {

/// Data common to all edges of a discrete rod, in consistent units.
template <class T>
struct DerMaterial {
  T length;           // of an edge at rest
  T mass, drag;       // of a node: kg, force per velocity; half of it at the tip
  T inertia;          // of an angle
  T stretch;          // EA/l
  Vec3<T> stiffness;  // of a joint between edges: diag(GJ, EI1, EI2)/l; clamp: twice
  T friction;         // of a joint: gamma/l; clamp: twice
  T rate;             // typical: speeds are of the order of `rate` lengths

  /// Returns the inertia of node i + 1 of n.
  T inertia_of_node(Weights w, int i, int n) const {
    return T(i + 1 < n ? 1 : 0.5) * (T(w.acc) * mass + T(w.vel) * drag);
  }
};

/// State that an edge keeps between steps.
template <class T>
struct DerEdge {
  Vec3<T> rest;                // strain of the joint before it
  Vec3<T> tangent, direction;  // reference frame: e0, e1
  T twist;  // of that joint at the start of the step, with whole turns (wound())

  /// Number of values per lane that steps change.
  static constexpr std::size_t kept = 7;
  /// Writes what steps change, of a lane.
  void keep(int lane, double* to) const {
    for (const Vec3<T>* x : {&tangent, &direction}) {
      store3(lane_of(*x, lane), to);
      to += 3;
    }
    *to = lane_of(twist, lane);
  }
  /// Restores what keep() wrote.
  void recall(int lane, const double* from) {
    set_lane(tangent, lane, load3(from));
    set_lane(direction, lane, load3(from + 3));
    set_lane(twist, lane, from[6]);
  }
};

/// Discrete elastic rod of models/maximal/der.cpp (clamped, edges of equal length,
/// extensible, dynamic twist) for the strands in the lanes of T. Newton's step
///
///     correction = S(w)^-1 r(q, v, a)
///
/// takes O(edges). Coordinates: e (3) and theta of every edge, in axes that do not turn.
/// Velocities and accelerations: the same, but those of the first edge are those of its
/// end, whatever the motion of the root.
///
/// With its frame (t, m1, m2) and length L, a change of an edge is a rotation omega (in
/// components of the frame) and a lengthening sigma,
///
///     de = sigma t + L (omega_2 m1 - omega_1 m2),    dtheta = omega . p,
///     p = (t + a)/(1 + a . t),  a the tangent of the reference frame.
///
/// A joint depends on rotations only. After elimination, all that follows an edge is
/// therefore a quadratic form of the position of its start and of the rotation of the
/// edge before. It is 6 x 6 as the articulated inertia of [Featherstone 1983]; banded
/// elimination over (x, theta) keeps 7 unknowns and has couplings of 11. In these
/// unknowns the small entries of twist are separate from the large ones of bending, which
/// matters in single precision.
///
/// `exact`: with the second derivatives of strains, edges and stretch, and the slopes of
/// rates of friction. These are symmetric except for the parts due to lengthening
/// (DerForces::ByLengthening).
template <class T, bool exact>
class DerStrand {
 public:
  /// Vector of these scalars.
  using Vec = Vec3<T>;
  /// Matrix of these scalars.
  using Matrix = Matrix3<T>;

  static constexpr int per_element = 4;  // unknowns of an edge

  /// Elimination by the kind of Jacobian.
  using Elimination =
      std::conditional_t<exact, DerExactElimination<T>, DerStiffElimination<T>>;
  /// Load of bodies by the kind of Jacobian.
  using Load = typename EdgeLoads<T, exact>::Load;
  /// Forces of edges and joints.
  using Forces = DerForces<T, exact>;
  /// An edge with the residual of its node.
  struct Placed : Elimination::Placed {
    Vec force;  // residual of the node at its end, without those of edges
    T turning;  // inertia times theta''
  };
  /// Factors of an element.
  using Factor = typename Elimination::Factor;

  /// Makes strands of this number of edges under gravity.
  DerStrand(int edges, const Vec& gravity) : n_(edges), gravity_(gravity) {}

  /// Returns the number of unknowns.
  int unknowns() const { return per_element * n_; }

  /// correction = S^-1 r at (q, v, a), with the loads of effects on the ends of edges, or
  /// null. If it is `exact`, edges resist turns by these `tensions`, which the correction
  /// replaces by those that it found (StressForm); else they are not used. Returns its
  /// size per lane: the largest of displacements over edges, angles, speeds over rate
  /// times edges, angular speeds over rate; NaN unless all are finite. `placed` and
  /// `factors` (edges) then serve again().
  TRESS_FLATTEN T newton(const DerMaterial<T>& m, const DerEdge<T>* edges,
                         const LaneClamp<T>& clamp, Weights w, const T* q, const T* v,
                         const T* a, const Load* loads, T* correction, Placed* placed,
                         Factor* factors, [[maybe_unused]] T* tensions) const {
    place<true>(m, edges, clamp, w, q, v, a, loads, placed);
    const T pos(w.pos), along = pos * m.stretch, turning = T(w.acc) * m.inertia;
    typename Elimination::Beyond beyond;
    Vec f_x{}, f_omega{}, moment_behind{};
    for (int i = n_ - 1; i >= 0; --i) {
      const Placed& e = placed[i];
      beyond.add_inertia(m.inertia_of_node(w, i, n_));
      if (loads != nullptr) [[unlikely]] {
        const auto& load = loads[i].load;
        if constexpr (exact) {
          beyond.xx =
              where_less(T(0), loads[i].some,
                         beyond.xx + pos * load.by_x + T(w.vel) * load.by_u, beyond.xx);
        } else {
          beyond.xx = where_less(T(0), loads[i].some, beyond.xx + load.block, beyond.xx);
        }
      }
      if constexpr (exact) {
        Elimination::eliminate(e, i == 0, pos, along, turning, e.moment - moment_behind,
                               tensions[i], beyond, factors[i], AnyPivots{});
      } else {
        Elimination::eliminate(e, i == 0, along, turning, beyond, factors[i],
                               AnyPivots{});
      }
      Elimination::reduce(e, factors[i], e.force, e.turning * e.p + e.moment, e.tension,
                          f_x, f_omega);
      if constexpr (exact) {
        moment_behind = e.turn * e.moment;
        f_omega = e.turn * f_omega - moment_behind;
      } else {
        f_omega = e.turn * (f_omega - e.moment);
      }
    }
    const T size = substitute(m, w, placed, factors, correction);
    if constexpr (exact) {
      for (int i = 0; i < n_; ++i) {
        const Placed& e = placed[i];
        tensions[i] = e.tension - along * dot(e.frame.e0, load3(correction + 4 * i));
      }
    }
    return size;
  }

  /// Computes a correction with the matrix of the last newton() at another state. `now`
  /// (edges): scratch.
  TRESS_FLATTEN T again(const DerMaterial<T>& m, const DerEdge<T>* edges,
                        const LaneClamp<T>& clamp, Weights w, const T* q, const T* v,
                        const T* a, const Load* loads, T* correction,
                        const Placed* placed, Factor* factors, Placed* now) const {
    place<false>(m, edges, clamp, w, q, v, a, loads, now);
    Vec f_x{}, f_omega{}, from_behind{};
    for (int i = n_ - 1; i >= 0; --i) {
      // The residual in terms of nodes and angles: it acts where the matrix was taken.
      const Placed& e = now[i];
      const Vec moment =
          e.moment - (i + 1 < n_ ? now[i + 1].turn * now[i + 1].moment : Vec{});
      const Vec force = e.force_by(moment);
      const Vec node = e.force + force - from_behind;
      from_behind = force;
      Elimination::reduce(placed[i], factors[i], node,
                          (e.turning + moment.x) * placed[i].p, T(0), f_x, f_omega);
      f_omega = placed[i].turn * f_omega;
    }
    return substitute(m, w, placed, factors, correction);
  }

  /// Begins a step: counts the turns of the twists and renews references. An edge that
  /// has turned by more than 60 degrees takes its present frame as the new reference, as
  /// renew_reference() in models/maximal/rod_edge.h. A second call changes nothing.
  /// Returns > 0 in lanes where some has.
  T renew(DerEdge<T>* edges, const LaneClamp<T>& clamp, T* q, T* v) const {
    T some(0);
    FrameOf<T> before = clamp.frame;
    for (int i = 0; i < n_; ++i) {
      const Vec e = load3(q + 4 * i), t = inverse_sqrt(dot(e, e)) * e;
      const FrameOf<T> now = frame(edges[i], t, q[4 * i + 3]);
      edges[i].twist = wound(strains(before, now).x, edges[i].twist);
      before = now;
      const T far = T(0.5) - dot(edges[i].tangent, t);
      if (all_up_to(far, 0)) [[likely]]
        continue;
      Vec rate = load3(v + 4 * i);
      if (i == 0) rate = rate - clamp.v;
      renew_lanes(edges[i], far, e, rate, q[4 * i + 3], v[4 * i + 3]);
      some = larger(some, far);
    }
    return some;
  }

  /// Computes the energies at (q, v); `at`: position of the root seen from the head's
  /// position.
  LaneEnergies<T> energies(const DerMaterial<T>& m, const DerEdge<T>* edges,
                           const LaneClamp<T>& clamp, Vec at, const T* q,
                           const T* v) const {
    const auto moves = [&](const T& mass, const Vec& u) {
      return T(0.5) * mass * dot(u, u);
    };
    const T end = T(0.5) * m.mass;
    LaneEnergies<T> sum{moves(end, clamp.v), T(0), end * at, dot(clamp.v, clamp.v), at};
    FrameOf<T> before = clamp.frame;
    Vec node_v{};
    for (int i = 0; i < n_; ++i) {
      const Vec edge = load3(q + 4 * i);
      node_v = node_v + load3(v + 4 * i);
      at = at + edge;
      const T by_length = inverse_sqrt(dot(edge, edge));
      const Vec t = by_length * edge;
      const T& rate = v[4 * i + 3];
      const T mass = i + 1 < n_ ? m.mass : end;
      sum.kinetic += moves(mass, node_v) + T(0.5) * m.inertia * rate * rate;
      sum.first = sum.first + mass * at;
      sum.passes(node_v);
      const FrameOf<T> now = frame(edges[i], t, q[4 * i + 3]);
      Vec strain = strains(before, now);
      strain.x = wound(strain.x, edges[i].twist);
      strain = strain - edges[i].rest;
      const T longer = dot(edge, t) - m.length, half(i == 0 ? 1 : 0.5);
      sum.elastic += T(0.5) * m.stretch * longer * longer +
                     half * (m.stiffness.x * strain.x * strain.x +
                             m.stiffness.y * strain.y * strain.y +
                             m.stiffness.z * strain.z * strain.z);
      before = now;
    }
    sum.tip = at;
    return sum;
  }

 private:
  /// Returns the frame of an edge along t.
  static FrameOf<T> frame(const DerEdge<T>& edge, const Vec& t, const T& theta) {
    return der_frame(edge.tangent, edge.direction, t,
                     T(1) / (T(1) + dot(edge.tangent, t)), theta);
  }
  /// Returns the strains of the joint between two frames.
  static Vec strains(const FrameOf<T>& before, const FrameOf<T>& now) {
    const Matrix turn{{now.back(before.e0), now.back(before.e1), now.back(before.e2)}};
    return DerJoint<T>(turn).value;
  }
  template <bool with_tangent>
  void place(const DerMaterial<T>& m, const DerEdge<T>* edges, const LaneClamp<T>& clamp,
             Weights w, const T* q, const T* v, const T* a, const Load* loads,
             Placed* placed) const {
    Vec node_v{}, node_a{};
    DerMotion<T> before{clamp.frame.back(clamp.omega), T(0)};
    FrameOf<T> frame_before = clamp.frame;
    for (int i = 0; i < n_; ++i) {
      Placed& e = placed[i];
      const Vec edge = load3(q + 4 * i), given = load3(v + 4 * i);
      node_v = node_v + given;
      node_a = node_a + load3(a + 4 * i);
      const DerMotion<T> own = Forces::edge(
          edges[i].tangent, edges[i].direction, q[4 * i + 3], edge,
          i == 0 ? given - clamp.v : given, v[4 * i + 3], m.stretch, m.length, e);
      DerJoint<T> joint = Forces::strain(frame_before, e);
      joint.value.x = wound(joint.value.x, edges[i].twist);
      const T half(i == 0 ? 2 : 1);
      Forces::template joint<with_tangent>(
          joint, joint.value - edges[i].rest, half * m.stiffness, half * m.friction, true,
          w, own, before, i > 0 ? &placed[i - 1] : nullptr, e);
      e.turning = m.inertia * a[4 * i + 3];
      const T part(i + 1 < n_ ? 1 : 0.5);
      e.force = part * (m.mass * (node_a - gravity_) + m.drag * node_v);
      if (loads != nullptr) [[unlikely]] {
        e.force = where_less(T(0), loads[i].some, e.force - loads[i].load.force, e.force);
      }
      frame_before = e.frame;
      before = own;
    }
  }

  T substitute(const DerMaterial<T>& m, Weights w, const Placed* placed,
               const Factor* factors, T* correction) const {
    Vec x{}, omega{};
    T most(0), angle(0), finite(0);  // the last: 0 or NaN
    for (int i = 0; i < n_; ++i) {
      const Placed& e = placed[i];
      const DerChange<T> own = der_change(e, factors[i], i == 0, x, omega);
      omega = own.omega;
      const Vec edge = e.change(omega, own.sigma);
      const T theta = dot(e.p, omega);
      store3(edge, correction + 4 * i);
      correction[4 * i + 3] = theta;
      x = x + edge;
      const T all = x.x + x.y + x.z + theta;
      finite += all - all;
      most = larger(larger(most, magnitude(x.z)), larger(magnitude(x.y), magnitude(x.x)));
      angle = larger(angle, magnitude(theta));
    }
    return larger(T(w.vel) / m.rate, T(w.pos)) * larger(angle, most / m.length) + finite;
  }

  /// Renews the reference frame in lanes with `far` > 0.
  [[gnu::noinline]] static void renew_lanes(DerEdge<T>& edge, T far, Vec e, Vec rate,
                                            T& theta, T& theta_rate) {
    const T by_length = inverse_sqrt(dot(e, e));
    const Vec t = by_length * e;
    const T beside = T(1) / (T(1) + dot(edge.tangent, t));
    const FrameOf<T> now = der_frame(edge.tangent, edge.direction, t, beside, theta);
    const T more = theta_rate + by_length * beside * dot(cross(t, edge.tangent), rate);
    const auto chosen = [&](const Vec& x, const Vec& y) {
      return Vec{where_up_to(far, 0, x.x, y.x), where_up_to(far, 0, x.y, y.y),
                 where_up_to(far, 0, x.z, y.z)};
    };
    edge.tangent = chosen(edge.tangent, t);
    edge.direction = chosen(edge.direction, now.e1);
    theta_rate = where_up_to(far, 0, theta_rate, more);
    theta = where_up_to(far, 0, theta, T(0));
  }

  int n_;
  Vec gravity_;
};

}  // namespace tress::models
