#pragma once

#include "contract/system.h"
#include "math/frame.h"
#include "math/lane_math.h"
#include "math/lanes.h"
#include "models/head/lane_energies.h"
#include "models/head/matrix3.h"

namespace tress::models {

/// What the edges of a discrete rod have in common, in consistent units.
template <class T>
struct DerMaterial {
  T length;           // of an edge at rest
  T mass, drag;       // of a node: kg, force per velocity; half of it at the tip
  T inertia;          // of an angle
  T stretch;          // EA/l
  Vec3<T> stiffness;  // of a joint between edges: diag(GJ, EI1, EI2)/l; clamp: twice
  T friction;         // of a joint: gamma/l; clamp: twice
  T rate;             // typical: speeds are of the order of `rate` lengths
};

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

/// Position and motion of the clamp's frame, axes as those of the edges.
template <class T>
struct DerClamp {
  FrameOf<T> frame;
  Vec3<T> v, omega;
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
  using Symmetric = Symmetric3<T>;

  static constexpr int per_element = 4;

  /// An edge and the joint before it at a state.
  struct Placed {
    FrameOf<T> frame;
    T length, inverse_length;
    Vec p;
    Matrix turn;  // from the frame to that of the edge before
    Vec moment;   // of the joint on the edge, components of the frame
    T tension;
    Vec force;       // residual of the node at its end, without those of edges
    T turning;       // inertia times theta''
    Symmetric both;  // derivatives of the moment by the rotation, of either edge
    Matrix across;   // if exact: of the moment on the edge before by omega
    T beside;        // a . t + 1, inverse
    Vec a;           // the reference tangent in components of the frame
  };
  /// Elimination of an edge.
  struct Factor {
    Symmetric pivot;       // inverse, of omega
    Matrix of_x, of_turn;  // omega = own - of_x x + of_turn (rotation of the edge before)
    Vec sigma_x, sigma_omega;
    T sigma;  // inverse pivot
    Vec own;
    T own_sigma;
  };

  DerStrand(int edges, const Vec& gravity) : n_(edges), gravity_(gravity) {}

  int unknowns() const { return per_element * n_; }

  /// correction = S^-1 r at (q, v, a). Returns its size per lane: the largest of
  /// displacements over edges, angles, speeds over rate times edges, angular speeds over
  /// rate; NaN unless all are finite. `placed` and `factors` (edges) then serve again().
  [[gnu::flatten]] T newton(const DerMaterial<T>& m, const DerEdge<T>* edges,
                            const DerClamp<T>& clamp, Weights w, const T* q, const T* v,
                            const T* a, T* correction, Placed* placed,
                            Factor* factors) const {
    place<true>(m, edges, clamp, w, q, v, a, placed);
    eliminate(m, w, placed, factors);
    return substitute(m, w, placed, factors, correction);
  }

  /// The same by the matrix of the last newton() at another state. `now` (edges):
  /// scratch.
  [[gnu::flatten]] T again(const DerMaterial<T>& m, const DerEdge<T>* edges,
                           const DerClamp<T>& clamp, Weights w, const T* q, const T* v,
                           const T* a, T* correction, const Placed* placed,
                           Factor* factors, Placed* now) const {
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
      reduce(placed[i], factors[i], node, (e.turning + along) * placed[i].p, T(0), f_x,
             f_omega);
      f_omega = placed[i].turn * f_omega;
    }
    return substitute(m, w, placed, factors, correction);
  }

  /// Takes the present frame of an edge as its reference if it has turned by more than 60
  /// degrees, as renew_reference() in models/maximal/rod_edge.h; a second call changes
  /// nothing.
  void renew(DerEdge<T>* edges, const DerClamp<T>& clamp, T* q, T* v) const {
    for (int i = 0; i < n_; ++i) {
      const Vec e = load3(q + 4 * i);
      const T far = T(0.5) - dot(edges[i].tangent, e) * inverse_sqrt(dot(e, e));
      if (all_up_to(far, 0)) [[likely]]
        continue;
      Vec rate = load3(v + 4 * i);
      if (i == 0) rate = rate - clamp.v;
      renew_lanes(edges[i], far, e, rate, q[4 * i + 3], v[4 * i + 3]);
    }
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
                           const DerClamp<T>& clamp, Vec at, const T* q,
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
      const Joint joint(turn);
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
  /// The joint's strains from turn(a, b) = (axis a before) . (axis b of the edge), and
  /// their gradients by the rotation of the edge in its components:
  /// models/maximal/joint_strain.h with all products written out.
  struct Joint {
    explicit Joint(const Matrix& r)
        : by(T(1) / (T(1) + r.row[0].x)),
          value{arc_tangent(r.row[2].y - r.row[1].z, r.row[1].y + r.row[2].z),
                by * (r.row[0].z - r.row[2].x), by * (r.row[1].x - r.row[0].y)},
          k{T(0), by * r.row[0].z, -(by * r.row[0].y)},
          twist{T(1), by * r.row[0].y, by * r.row[0].z},
          curvature1{-(by * r.row[0].y), by * (r.row[0].x + r.row[2].z) + value.y * k.y,
                     -(by * r.row[2].y) + value.y * k.z},
          curvature2{-(by * r.row[0].z), -(by * r.row[1].z) + value.z * k.y,
                     by * (r.row[0].x + r.row[1].y) + value.z * k.z} {}
    T by;
    Vec value, k, twist, curvature1, curvature2;
  };

  static void add_square(Symmetric& s, const T& w, const Vec& x) {
    const Vec y = w * x;
    s.xx += y.x * x.x;
    s.yy += y.y * x.y;
    s.zz += y.z * x.z;
    s.xy += y.x * x.y;
    s.xz += y.x * x.z;
    s.yz += y.y * x.z;
  }
  /// s += w (x y^T + y x^T)/2.
  static void add_product(Symmetric& s, const T& w, const Vec& x, const Vec& y) {
    const Vec z = (T(0.5) * w) * x;
    s.xx += T(2) * z.x * y.x;
    s.yy += T(2) * z.y * y.y;
    s.zz += T(2) * z.z * y.z;
    s.xy += z.x * y.y + z.y * y.x;
    s.xz += z.x * y.z + z.z * y.x;
    s.yz += z.y * y.z + z.z * y.y;
  }
  static Symmetric less_square(const Symmetric& s, const T& w, const Vec& x) {
    Symmetric all = s;
    add_square(all, -w, x);
    return all;
  }

  template <bool with_tangent>
  void place(const DerMaterial<T>& m, const DerEdge<T>* edges, const DerClamp<T>& clamp,
             Weights w, const T* q, const T* v, const T* a, Placed* placed) const {
    Vec node_v{}, node_a{}, spin_before = clamp.frame.back(clamp.omega);
    FrameOf<T> before = clamp.frame;
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
      e.beside = T(1) / (T(1) + dot(reference, t));
      e.frame = frame(edges[i], t, e.beside, q[4 * i + 3]);
      const T a1 = dot(reference, e.frame.e1), a2 = dot(reference, e.frame.e2);
      e.p = {T(1), e.beside * a1, e.beside * a2};
      if constexpr (exact && with_tangent) e.a = {T(0), a1, a2};
      // theta' = spin . p.
      const T spin1 = -(e.inverse_length * dot(rate, e.frame.e2)),
              spin2 = e.inverse_length * dot(rate, e.frame.e1);
      const Vec spin{v[4 * i + 3] - spin1 * e.p.y - spin2 * e.p.z, spin1, spin2};
      e.turn = {
          {e.frame.back(before.e0), e.frame.back(before.e1), e.frame.back(before.e2)}};
      const Joint joint(e.turn);
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
        Symmetric both;
        add_square(both, T(w.pos) * stiffness.x + damped, joint.twist);
        add_square(both, T(w.pos) * stiffness.y + damped, joint.curvature1);
        add_square(both, T(w.pos) * stiffness.z + damped, joint.curvature2);
        if constexpr (exact) add_second(joint, T(w.pos) * stress, both, e);
        e.both = both;
      }
      before = e.frame;
      spin_before = spin;
    }
  }

  /// The sum of stress times second derivative of each strain by the rotations of both
  /// edges, as JointStrain::second(), in components of the edge behind.
  static void add_second(const Joint& joint, const Vec& stress, Symmetric& both,
                         Placed& e) {
    const Matrix& r = e.turn;
    const T s2 = joint.by * stress.z, s1 = -(joint.by * stress.y);
    const T s = s2 * joint.value.z - s1 * joint.value.y;
    const Vec minus = s2 * r.row[1] + s1 * r.row[2], plus{s, s2, s1};
    const Vec t_minus = r.row[0], t_plus{T(1), T(0), T(0)};
    const Vec g = T(2) * stress.y * joint.curvature1 +
                  T(2) * stress.z * joint.curvature2 + stress.x * joint.twist;
    Symmetric relative = both;
    relative.xx -= s;
    relative.yy -= s;
    relative.zz -= s;
    add_product(relative, T(1), g, joint.k);
    const T half = T(0.5) * stress.x;
    e.across = half * cross_matrix(joint.twist) - full(relative);
    e.across = {{e.across.row[0] + plus.x * t_minus - minus,
                 e.across.row[1] + plus.y * t_minus, e.across.row[2] + plus.z * t_minus}};
    both = relative;
    add_product(both, T(1), minus, t_plus);
    add_product(both, T(-1), plus, t_minus);
  }

  /// From the tip to the root; right sides as well.
  void eliminate(const DerMaterial<T>& m, Weights w, const Placed* placed,
                 Factor* factors) const {
    const T inertia = T(w.acc) * m.mass + T(w.vel) * m.drag;
    Symmetric xx{}, ww{};
    Matrix xw{};
    Vec f_x{}, f_omega{};
    Vec moment_behind{};  // on the edge by the joint behind it
    for (int i = n_ - 1; i >= 0; --i) {
      const Placed& e = placed[i];
      Factor& f = factors[i];
      const T own = T(i + 1 < n_ ? 1 : 0.5) * inertia;
      xx.xx += own;
      xx.yy += own;
      xx.zz += own;
      // The end's displacement is x + sigma t + L (omega_2 m1 - omega_1 m2).
      const Vec &t = e.frame.e0, &m1 = e.frame.e1, &m2 = e.frame.e2;
      const Vec x_t = xx * t, x_1 = e.length * (xx * m1), x_2 = e.length * (xx * m2);
      const Vec c0 = xw.column(0), c1 = xw.column(1), c2 = xw.column(2);
      const Vec lever1 = e.length * m1, lever2 = e.length * m2;
      Vec h0 = c0, h1 = c1 - x_2, h2 = c2 + x_1;  // of x and omega
      Symmetric h;
      h.xx = ww.xx;
      h.xy = ww.xy - dot(lever2, c0);
      h.xz = ww.xz + dot(lever1, c0);
      h.yy = ww.yy - dot(lever2, c1 + h1);
      h.yz = ww.yz - dot(lever2, h2) + dot(lever1, c1);
      h.zz = ww.zz + dot(lever1, c2 + h2);
      add_square(h, T(w.acc) * m.inertia, e.p);
      Vec s_omega{dot(t, h0), dot(t, h1), dot(t, h2)};
      T sigma = dot(t, x_t) + T(w.pos) * m.stretch;
      if constexpr (exact) {
        add_second_of_edge(m, T(w.pos), e, e.moment - moment_behind, h, s_omega);
      }
      f.sigma = T(1) / sigma;
      f.sigma_x = x_t;
      f.sigma_omega = s_omega;
      xx = less_square(xx, f.sigma, x_t);
      h = less_square(h, f.sigma, s_omega);
      const Vec by = f.sigma * s_omega;
      h0 = h0 - by.x * x_t;
      h1 = h1 - by.y * x_t;
      h2 = h2 - by.z * x_t;
      const Matrix of_omega{{h0, h1, h2}};  // rows: omega, columns: x
      f.pivot = inverse(h + e.both);
      f.of_x = f.pivot * of_omega;
      if constexpr (exact) {
        f.of_turn = T(-1) * (f.pivot * e.across.transposed());
      } else {
        f.of_turn = f.pivot * full(e.both);
      }
      reduce(e, f, e.force, e.turning * e.p + e.moment, e.tension, f_x, f_omega);
      moment_behind = e.turn * e.moment;
      f_omega = e.turn * f_omega - moment_behind;
      if (i == 0) break;
      xx = xx - upper(of_omega.transposed(), f.of_x.transposed());
      xw = of_omega.transposed() * f.of_turn * e.turn.transposed();
      Symmetric turned;
      if constexpr (exact) {
        turned = e.both + upper(e.across * f.of_turn);
      } else {
        // K - K (K + H)^-1 K without cancellation.
        turned = upper(f.of_turn.transposed(), full(h));
      }
      ww = congruent(e.turn, turned);
    }
  }

  /// pos times the second derivative of the rotation and of the length of an edge, with
  /// the moment and the tension on it.
  static void add_second_of_edge(const DerMaterial<T>&, const T& pos, const Placed& e,
                                 const Vec& moment, Symmetric& h, Vec& s_omega) {
    const T turned = pos * moment.x * e.beside;
    // (omega . (t x moment)) (omega . t)
    h.xy -= T(0.5) * pos * moment.z;
    h.xz += T(0.5) * pos * moment.y;
    // (moment . t)/(1 + a . t)^2 (omega . a) (omega . (t x a))
    add_product(h, turned * e.beside, e.a, {T(0), -e.a.z, e.a.y});
    const T pull = pos * e.tension * e.length;
    h.yy += pull;
    h.zz += pull;
    const T by = pos * e.inverse_length;
    s_omega =
        s_omega + e.inverse_length * (turned * e.a) - by * Vec{T(0), moment.y, moment.z};
  }

  /// Right sides of an edge's unknowns, given residuals of the node at its end and of
  /// omega and sigma; passes on what is left to the start and to the edge before, in the
  /// edge's components.
  static void reduce(const Placed& e, Factor& f, const Vec& force, const Vec& moment,
                     const T& tension, Vec& f_x, Vec& f_omega) {
    f_x = f_x + force;
    const T f1 = e.length * dot(e.frame.e1, f_x), f2 = e.length * dot(e.frame.e2, f_x);
    f.own_sigma = dot(e.frame.e0, f_x) + tension;
    const T by = f.sigma * f.own_sigma;
    const Vec tau = f_omega + moment + Vec{T(0), -f2, f1} - by * f.sigma_omega;
    f.own = f.pivot * tau;
    f_x = f_x - by * f.sigma_x - f.of_x.back(tau);
    f_omega = f.of_turn.back(tau);
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
          f.sigma * (f.own_sigma - dot(f.sigma_x, x) - dot(f.sigma_omega, omega));
      const Vec edge = sigma * e.frame.e0 + (e.length * omega.z) * e.frame.e1 -
                       (e.length * omega.y) * e.frame.e2;
      const T theta = dot(e.p, omega);
      store3(edge, correction + 4 * i);
      correction[4 * i + 3] = theta;
      x = x + edge;
      const T all = x.x + x.y + x.z + theta;
      finite += all - all;
      most = larger(larger(magnitude(x.x), magnitude(x.y)), larger(magnitude(x.z), most));
      angle = larger(magnitude(theta), angle);
    }
    return larger(T(w.pos), T(w.vel) / m.rate) * larger(most / m.length, angle) + finite;
  }

  static Symmetric inverse(const Symmetric& h) {
    const T first = h.yy * h.zz - h.yz * h.yz;
    const T second = h.xz * h.yz - h.xy * h.zz, third = h.xy * h.yz - h.xz * h.yy;
    const T by = T(1) / (h.xx * first + h.xy * second + h.xz * third);
    return {first * by,
            (h.xx * h.zz - h.xz * h.xz) * by,
            (h.xx * h.yy - h.xy * h.xy) * by,
            second * by,
            third * by,
            (h.xy * h.xz - h.xx * h.yz) * by};
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
