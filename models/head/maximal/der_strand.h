#pragma once

#include <type_traits>

#include "contract/system.h"
#include "math/frame.h"
#include "math/instructions.h"
#include "math/lane_math.h"
#include "math/lanes.h"
#include "models/head/lane_energies.h"
#include "models/head/lane_root.h"
#include "models/head/maximal/der_elimination.h"

namespace tress::models {

/// What an edge remembers.
template <class T>
struct DerEdge {
  Vec3<T> rest;                // strain of the joint before it
  Vec3<T> tangent, direction;  // reference frame: e0, e1

  /// What steps change, of a lane.
  static constexpr std::size_t kept = 6;
  void keep(int lane, double* to) const {
    for (const Vec3<T>* x : {&tangent, &direction}) {
      store3(lane_of(*x, lane), to);
      to += 3;
    }
  }
  void recall(int lane, const double* from) {
    set_lane(tangent, lane, load3(from));
    set_lane(direction, lane, load3(from + 3));
  }
};

/// The discrete elastic rod of models/maximal/der.cpp (clamped, edges of equal length,
/// extensible, dynamic twist) for as many strands as T has lanes: Newton's step
///
///     correction = S(w)^-1 r(q, v, a)
///
/// in O(edges). Coordinates: of every edge e (3) and theta, in axes that do not turn.
/// Velocities and accelerations: the same, but the first edge's are those of its end,
/// whatever the root does.
///
/// With its frame (t, m1, m2) and length L, a change of an edge is a rotation omega (in
/// components of the frame) and a lengthening sigma,
///
///     de = sigma t + L (omega_2 m1 - omega_1 m2),    dtheta = omega . p,
///     p = (t + a)/(1 + a . t),  a the tangent of the reference frame.
///
/// A joint depends on rotations only. So everything beyond an edge is, after elimination,
/// a quadratic form of the position of its start and of the rotation of the edge before:
/// 6 x 6 as the articulated inertia of [Featherstone 1983], where banded elimination over
/// (x, theta) keeps 7 unknowns and has couplings of 11. In these unknowns the small
/// entries of twist stay apart from the large ones of bending, which matters in 32 bits.
///
/// `exact`: with the second derivatives of strains, edges and stretch, but without the
/// slopes of rates of friction, which are not symmetric: Newton's iteration then
/// converges linearly, by a factor of the order of the rotation in a step.
template <class T, bool exact>
class DerStrand {
 public:
  using Vec = Vec3<T>;
  using Matrix = Matrix3<T>;

  static constexpr int per_element = 4;

  using Elimination =
      std::conditional_t<exact, DerExactElimination<T>, DerStiffElimination<T>>;
  using Placed = typename Elimination::Placed;
  using Factor = typename Elimination::Factor;

  DerStrand(int edges, const Vec& gravity) : n_(edges), gravity_(gravity) {}

  int unknowns() const { return per_element * n_; }

  /// correction = S^-1 r at (q, v, a). Returns its size per lane: the largest of
  /// displacements over edges, angles, speeds over rate times edges, angular speeds over
  /// rate; NaN unless all are finite. `placed` and `factors` (edges) then serve again().
  TRESS_FLATTEN T newton(const DerMaterial<T>& m, const DerEdge<T>* edges,
                         const LaneClamp<T>& clamp, Weights w, const T* q, const T* v,
                         const T* a, T* correction, Placed* placed,
                         Factor* factors) const {
    place<true>(m, edges, clamp, w, q, v, a, placed);
    Elimination::run(n_, m, w, placed, factors);
    return substitute(m, w, placed, factors, correction);
  }

  /// The same by the matrix of the last newton() at another state. `now` (edges):
  /// scratch.
  TRESS_FLATTEN T again(const DerMaterial<T>& m, const DerEdge<T>* edges,
                        const LaneClamp<T>& clamp, Weights w, const T* q, const T* v,
                        const T* a, T* correction, const Placed* placed, Factor* factors,
                        Placed* now) const {
    place<false>(m, edges, clamp, w, q, v, a, now);
    Vec f_x{}, f_omega{}, from_behind{};
    for (int i = n_ - 1; i >= 0; --i) {
      // The residual in terms of nodes and angles: it acts where the matrix was taken.
      const Placed& e = now[i];
      const Vec moment =
          e.moment - (i + 1 < n_ ? now[i + 1].turn * now[i + 1].moment : Vec{});
      // moment . omega = force . de + torque dtheta.
      const Vec p = e.p;
      const T along = moment.x;
      const Vec force = e.tension * e.frame.e0 +
                        (e.inverse_length * (moment.z - along * p.z)) * e.frame.e1 -
                        (e.inverse_length * (moment.y - along * p.y)) * e.frame.e2;
      const Vec node = e.force + force - from_behind;
      from_behind = force;
      Elimination::reduce(placed[i], factors[i], node, (e.turning + along) * placed[i].p,
                          T(0), f_x, f_omega);
      f_omega = placed[i].turn * f_omega;
    }
    return substitute(m, w, placed, factors, correction);
  }

  /// Takes the present frame of an edge as its reference if it has turned by more than 60
  /// degrees, as renew_reference() in models/maximal/rod_edge.h; a second call changes
  /// nothing. Returns > 0 in lanes where some has.
  T renew(DerEdge<T>* edges, const LaneClamp<T>& clamp, T* q, T* v) const {
    T some(0);
    for (int i = 0; i < n_; ++i) {
      const Vec e = load3(q + 4 * i);
      const T far = T(0.5) - dot(edges[i].tangent, e) * inverse_sqrt(dot(e, e));
      if (all_up_to(far, 0)) [[likely]]
        continue;
      Vec rate = load3(v + 4 * i);
      if (i == 0) rate = rate - clamp.v;
      renew_lanes(edges[i], far, e, rate, q[4 * i + 3], v[4 * i + 3]);
      some = larger(some, far);
    }
    return some;
  }

  /// Frame of an edge as models/maximal/rod_edge.h's edge_frame().
  static FrameOf<T> frame(const DerEdge<T>& edge, const Vec& t, const T& beside,
                          const T& theta) {
    const SineCosine<T> turn = sine_cosine(theta);
    const Vec u =
        turn.cosine * edge.direction + turn.sine * cross(edge.tangent, edge.direction);
    const Vec m1 = u - (dot(u, t) * beside) * (edge.tangent + t);
    return {t, m1, cross(t, m1)};
  }

  /// At (q, v); `at`: of the root, seen from the head's position.
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
      const FrameOf<T> now =
          frame(edges[i], t, T(1) / (T(1) + dot(edges[i].tangent, t)), q[4 * i + 3]);
      const Matrix turn{{now.back(before.e0), now.back(before.e1), now.back(before.e2)}};
      const DerJoint<T> joint(turn);
      const Vec strain = joint.value - edges[i].rest;
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
  struct Rate {
    Vec spin;
    T lengthening;
  };

  template <bool with_tangent>
  void place(const DerMaterial<T>& m, const DerEdge<T>* edges, const LaneClamp<T>& clamp,
             Weights w, const T* q, const T* v, const T* a, Placed* placed) const {
    Vec node_v{}, node_a{}, spin_before = clamp.frame.back(clamp.omega);
    FrameOf<T> before = clamp.frame;
    [[maybe_unused]] T lengthening_before(0);
    for (int i = 0; i < n_; ++i) {
      Placed& e = placed[i];
      const Vec edge = load3(q + 4 * i), given = load3(v + 4 * i);
      node_v = node_v + given;
      node_a = node_a + load3(a + 4 * i);
      const Vec rate = i == 0 ? given - clamp.v : given;
      const T square = dot(edge, edge);
      e.inverse_length = inverse_sqrt(square);
      e.length = square * e.inverse_length;
      const Vec t = e.inverse_length * edge;
      const Vec& reference = edges[i].tangent;
      const T beside = T(1) / (T(1) + dot(reference, t));
      e.frame = frame(edges[i], t, beside, q[4 * i + 3]);
      e.p = {T(1), beside * dot(reference, e.frame.e1),
             beside * dot(reference, e.frame.e2)};
      // theta' = spin . p.
      const T spin1 = -(e.inverse_length * dot(rate, e.frame.e2)),
              spin2 = e.inverse_length * dot(rate, e.frame.e1);
      const Vec spin{v[4 * i + 3] - spin1 * e.p.y - spin2 * e.p.z, spin1, spin2};
      e.turn = {
          {e.frame.back(before.e0), e.frame.back(before.e1), e.frame.back(before.e2)}};
      const DerJoint<T> joint(e.turn);
      const Vec relative = spin - e.turn.back(spin_before);
      const T half(i == 0 ? 2 : 1);
      const Vec stiffness = half * m.stiffness;
      const T friction = half * m.friction;
      const Vec strain = joint.value - edges[i].rest;
      const Vec stress{
          stiffness.x * strain.x + friction * dot(joint.twist, relative),
          stiffness.y * strain.y + friction * dot(joint.curvature1, relative),
          stiffness.z * strain.z + friction * dot(joint.curvature2, relative)};
      e.moment = stress.x * joint.twist + stress.y * joint.curvature1 +
                 stress.z * joint.curvature2;
      e.tension = m.stretch * (e.length - m.length);
      e.turning = m.inertia * a[4 * i + 3];
      const T part(i + 1 < n_ ? 1 : 0.5);
      e.force = part * (m.mass * (node_a - gravity_) + m.drag * node_v);
      if constexpr (with_tangent) {
        const T damped = T(w.vel) * friction;
        e.stiff = joint.stiff(T(w.pos) * stiffness + Vec{damped, damped, damped});
        if constexpr (exact) {
          second_of_joint(joint, T(w.pos) * stress, e);
          const T lengthening = dot(t, rate);
          add_friction(joint, T(w.pos) * friction, {spin, lengthening},
                       {spin_before, lengthening_before},
                       i > 0 ? &placed[i - 1] : nullptr, e);
          lengthening_before = lengthening;
        }
      }
      before = e.frame;
      spin_before = spin;
    }
  }

  static void second_of_joint(const DerJoint<T>& joint, const Vec& stress, Placed& e) {
    const auto form = joint.second(e.turn, stress);
    e.ww = full(e.stiff + form.alike);
    e.oo = e.ww;
    e.ow = form.across - full(e.stiff);
    e.wo = e.ow.transposed();
  }

  /// The rate of a strain changes with the place: its gradient times the second
  /// derivative along the motion.
  static void add_friction(const DerJoint<T>& joint, const T& friction, const Rate& own,
                           const Rate& before, const Placed* edge_before, Placed& e) {
    const Vec spin_before = e.turn.back(before.spin);
    const T o(0), one(1);
    const auto add = [&](const Vec& slope, const Vec& unit) {
      const auto form = joint.second(e.turn, unit);
      const DerEdgeForm<T> of_edge(e.p, e.inverse_length, slope);
      const Vec by_w = form.across.back(spin_before) + form.alike * own.spin +
                       of_edge.omega * own.spin + own.lengthening * of_edge.sigma;
      Vec by_o = form.alike * spin_before + form.across * own.spin;
      if (edge_before != nullptr) {
        const DerEdgeForm<T> of_before(edge_before->p, edge_before->inverse_length,
                                       Vec{} - e.turn * slope);
        by_o = by_o + e.turn.back(of_before.omega * before.spin +
                                  before.lengthening * of_before.sigma);
      }
      const Matrix w = dyad(friction * slope, by_w),
                   turned = dyad(friction * slope, by_o);
      e.ww = e.ww + w;
      e.wo = e.wo + turned;
      e.ow = e.ow - w;
      e.oo = e.oo - turned;
    };
    add(joint.twist, {one, o, o});
    add(joint.curvature1, {o, one, o});
    add(joint.curvature2, {o, o, one});
  }

  T substitute(const DerMaterial<T>& m, Weights w, const Placed* placed,
               const Factor* factors, T* correction) const {
    Vec x{}, omega{};
    T most(0), angle(0), finite(0);  // the last: 0 or NaN
    for (int i = 0; i < n_; ++i) {
      const Placed& e = placed[i];
      const Factor& f = factors[i];
      Vec own = f.own - f.of_x * x;
      if (i > 0) own = own + f.of_turn * e.turn.back(omega);
      omega = own;
      const T sigma =
          f.by * (f.own_sigma - dot(f.sigma_x, x) - dot(f.sigma_omega, omega));
      const Vec edge = sigma * e.frame.e0 + (e.length * omega.z) * e.frame.e1 -
                       (e.length * omega.y) * e.frame.e2;
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

  /// Where `far` > 0.
  [[gnu::noinline]] static void renew_lanes(DerEdge<T>& edge, T far, Vec e, Vec rate,
                                            T& theta, T& theta_rate) {
    const T by_length = inverse_sqrt(dot(e, e));
    const Vec t = by_length * e;
    const T beside = T(1) / (T(1) + dot(edge.tangent, t));
    const FrameOf<T> now = frame(edge, t, beside, theta);
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
