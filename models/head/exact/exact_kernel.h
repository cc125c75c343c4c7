#pragma once

#include "models/head/exact/varied_element.h"

namespace tress::models {

/// Newton's step of ReducedKernel's strands with all derivatives of the residual:
///
///     x = S^-1 r,   S = w.pos dr/dq + w.vel dr/dv + w.acc dr/da
///
/// The equations are those of models/reduced/exact_tangent.h. A frame's state is the
/// variation of its velocity (v, omega) and acceleration (a, alpha) in its own
/// components, in which gravity, inertia and linear drag know no displacement. Of an
/// element with the state s at its start, unknowns x and the wrench w_tip on its tip
///
///     s_tip = A s + B x,    w = C s + D x + G w_tip,    r = R s + H x + J w_tip
///
/// What hangs on a tip answers with w_tip = L s_tip + beta [models/reduced/
/// recursive_solver.h]; elimination of x from r = b passes to the start
///
///     L' = C + G L A - Y R',  Y = (D + G L B) H'^-1,  R' = R + J L A,  H' = H + J L B
///     beta' = G beta + Y (b - J beta)
///
/// A and G are motions of a rigid body but for how omega enters accelerations, so they
/// act by cross products, in the components of the start. x-columns are derivatives of
/// the element's tip and wrench by varied numbers (VariedElement), s-columns closed sums
/// over its points. H' is inverted as it stands, without the exchange of rows: Newton's
/// iteration mends what that costs.
template <class Kind>
class ExactKernel {
 public:
  using Kernel = ReducedKernel<Kind>;
  using T = typename Kind::Real;
  using Vec = Vec3<T>;
  using Matrix = Matrix3<T>;
  using Material = ReducedMaterial<T>;
  using Motion = ReducedMotion<T>;

  /// Of an element between sweeps.
  struct Factors {
    Motion start;
    Matrix rotation;  // of its tip
    Vec position;
    Matrix slope, turn;           // rows of J: J^T, in the components of the start
    Matrix of_omega, of_turning;  // omega in the acceleration of the tip
    std::array<Matrix, 4> tip;    // B
    Matrix pivot;                 // H'^-1
    std::array<Matrix, 4> z;      // H'^-1 R'
    Matrix force, moment;         // Y
    Vec u;                        // H'^-1 (b - J beta)
    // Where loads feel displacements, in these lanes 1 and else 0.
    T placed;
    Matrix shift, rotated;             // their part of B
    std::array<Matrix, 2> z_of_place;  // and of z
  };

  explicit ExactKernel(const Kernel& kernel) : kernel_(kernel) {}

  /// Motion at the state, for loads in `scratch`; returns what newton() needs.
  TRESS_FLATTEN Motion move(const Material& m, const Motion& root, const Vec* q,
                            const Vec* v, const Vec* a, typename Kernel::Scratch* scratch,
                            Factors* factors) const {
    Motion at = root;
    for (int i = 0; i < kernel_.elements(); ++i) {
      factors[i].start = at;
      scratch[i].q = q[i];
      Kind::template move<true>(m, q[i], v[i], a[i], at, scratch[i].kept);
    }
    return at;
  }
  /// x in `correction`; returns its largest entry per lane, NaN unless all are finite.
  /// `end`: what move() returned. `rest(i)`: of an element.
  /// `loads`: of an element null or its points; null if there are none.
  template <class Rest>
  TRESS_FLATTEN T newton(const Material& m, const Motion& end,
                         const ExactPoint<T>* const* loads, Rest rest, Weights w,
                         const Vec* q, const Vec* v, const Vec* a, Vec* correction,
                         Factors* factors) const {
    const int n = kernel_.elements();
    Hanging hanging{};
    for (int i = n - 1; i >= 0; --i) {
      Factors& e = factors[i];
      const T rotor = T(i + 1 < n ? 1 : Kind::rotors_of_last) * m.rotor;
      add_rotor(rotor, i + 1 < n ? factors[i + 1].start : end, hanging);
      const VariedElement<Kind> element(m, w, q[i], v[i], a[i]);
      Columns columns;
      own(m, element, T(w.pos), hanging, e, columns);
      const auto bending = Kernel::bending(m, w, i, q[i], rest(i), v[i]);
      columns.unknown = columns.unknown + bending.moment;
      columns.x.own = columns.x.own + diagonal(bending.tangent);
      carry(hanging, e, columns);
      // One code with and without loads: the same bits for strands that have none.
      e.placed = hanging.placed;
      Places places{};
      if (any_less(T(0), hanging.placed)) carry(hanging, T(w.pos), e, columns, places);
      if (loads != nullptr && loads[i] != nullptr) [[unlikely]] {
        add_loads(m, element, loads[i], e, columns, places);
      }
      eliminate(columns, e, hanging);
      if (any_less(T(0), e.placed)) eliminate(places, e, hanging);
    }
    return corrections(factors, correction);
  }

  /// The same by the factors of the last newton(), for the residual in `correction`.
  TRESS_FLATTEN T again(Vec* correction, Factors* factors) const {
    Vec force, moment;
    for (int i = kernel_.elements() - 1; i >= 0; --i) {
      hang(factors[i], correction[i], force, moment);
    }
    return corrections(factors, correction);
  }

 private:
  /// Of a column of states or unknowns: wrench about the element's start, and what the
  /// unknowns feel.
  struct Column {
    Matrix force, moment, own;
  };
  enum State { velocity, omega, acceleration, alpha };
  struct Columns {
    Column x;
    std::array<Column, 4> state;
    Vec force, moment, unknown;  // of the residual
  };
  using Places = std::array<Column, 2>;  // of displacements (d, phi)
  struct Wrench {
    Matrix force, moment;
  };
  /// On a tip, in its components.
  struct Hanging {
    std::array<Wrench, 4> state;  // L
    Vec force, moment;            // of the residual
    Vec beta_force, beta_moment;
    T placed;                     // as Factors::placed
    std::array<Wrench, 2> place;  // L of displacements
  };

  static void add_rotor(const T& rotor, const Motion& tip, Hanging& h) {
    const Vec& w = tip.omega;
    h.moment = h.moment + rotor_moment(rotor, w, tip.alpha);
    h.state[alpha].moment.row[0].x += rotor;
    Matrix& by_omega = h.state[omega].moment;
    by_omega.row[1].x += rotor * w.z;
    by_omega.row[1].z += rotor * w.x;
    by_omega.row[2].x -= rotor * w.y;
    by_omega.row[2].y -= rotor * w.x;
  }

  /// What an element does by itself, and how its tip moves: C, D, R, H, A, B.
  void own(const Material& m, const VariedElement<Kind>& element, const T& pos,
           const Hanging& hanging, Factors& e, Columns& to) const {
    const Motion& from = e.start;
    const VariedTip<T> tip = element.tip();
    e.rotation = tip.rotation;
    e.position = value_of(tip.position);
    e.slope = value_of(tip.slope);
    e.turn = value_of(tip.turn);
    // By dq the tip turns by theta.
    const Matrix theta = pos * e.turn;
    move_tip(from, tip, theta, e);
    const auto turned = [&](const Vec& x) {
      return with_parts(x, cross(theta.column(0), x), cross(theta.column(1), x),
                        cross(theta.column(2), x));
    };
    const VariedVec<T> force = turned(e.rotation * hanging.force),
                       moment = turned(e.rotation * hanging.moment);
    ElementSums<T> sums;
    const VariedWrench<T> inertial = element.inertial(kernel_, from, sums);
    const VariedVec<T> all_force = inertial.force + force,
                       all_moment = inertial.moment + moment + cross(tip.position, force),
                       unknown = inertial.unknown + tip.slope.back(force) +
                                 tip.turn.back(moment);
    to.force = value_of(all_force);
    to.moment = value_of(all_moment);
    to.unknown = value_of(unknown);
    to.x = {parts_of(all_force), parts_of(all_moment), parts_of(unknown)};
    add_inertia(m, from, sums, to);
  }

  static void move_tip(const Motion& from, const VariedTip<T>& tip, const Matrix& theta,
                       Factors& e) {
    const VariedVec<T> arm = cross(from.omega, tip.position);
    const VariedVec<T> v = Vec(from.v) + arm + tip.velocity,
                       w = Vec(from.omega) + tip.turning,
                       a = Vec(from.a) + cross(from.alpha, tip.position) +
                           tip.acceleration +
                           cross(from.omega, arm + T(2) * tip.velocity),
                       spin = Vec(from.alpha) + tip.spinning +
                              cross(from.omega, tip.turning);
    // d(E^T y) = E^T (dy + y x theta).
    const auto columns = [&](const VariedVec<T>& y) {
      return parts_of(y) + cross_times(value_of(y), theta);
    };
    e.tip = {columns(v), columns(w), columns(a), columns(spin)};
    e.of_omega = turning_with(from.omega, e.position, value_of(tip.velocity));
    e.of_turning = cross_matrix(Vec{} - value_of(tip.turning));
  }

  /// x to omega x (x x p) + x x (omega x p + 2 u).
  static Matrix turning_with(const Vec& omega, const Vec& p, const Vec& u) {
    Matrix all = dyad(omega, p) - dyad(T(2) * p, omega) - cross_matrix(T(2) * u);
    const T along = dot(omega, p);
    all.row[0].x += along;
    all.row[1].y += along;
    all.row[2].z += along;
    return all;
  }

  /// The element's mass, drag, and centrifugal and Coriolis forces by state.
  static void add_inertia(const Material& m, const Motion& from,
                          const ElementSums<T>& sums, Columns& to) {
    const Matrix lever = cross_matrix(sums.first);
    const Matrix second = less_than_trace(full(sums.second));
    const auto add = [&](const T& by, State shift, State turn) {
      to.state[shift] = {times_one(by * sums.one), by * lever, by * sums.momentum};
      to.state[turn] = {T(-1) * (by * lever), by * second, by * sums.spin};
    };
    add(m.drag, velocity, omega);
    add(m.density, acceleration, alpha);
    const Vec& w = from.omega;
    Column& by_omega = to.state[omega];
    by_omega.force = by_omega.force + m.density * turning_with(w, sums.first, sums.moved);
    by_omega.moment = by_omega.moment + m.density * (cross_matrix(sums.second * w) -
                                                     cross_times(w, full(sums.second)) +
                                                     T(2) * less_than_trace(sums.moving));
    by_omega.own = by_omega.own + m.density * sums.convective;
  }

  static Matrix diagonal(const Vec& x) {
    const T o(0);
    return {{{x.x, o, o}, {o, x.y, o}, {o, o, x.z}}};
  }
  static Matrix times_one(const T& x) { return diagonal({x, x, x}); }
  /// (trace m) I - m.
  static Matrix less_than_trace(const Matrix& m) {
    return times_one(m.row[0].x + m.row[1].y + m.row[2].z) - m;
  }

  /// Adds what hangs on the tip: G L A, G L B, J L A, J L B.
  static void carry(const Hanging& hanging, const Factors& e, Columns& to) {
    std::array<Wrench, 4> by;
    const Matrix back = e.rotation.transposed();
    for (std::size_t k = 0; k < 4; ++k) {
      by[k] = {e.rotation * hanging.state[k].force * back,
               e.rotation * hanging.state[k].moment * back};
    }
    Wrench x{by[0].force * e.tip[0], by[0].moment * e.tip[0]};
    for (std::size_t k = 1; k < 4; ++k) {
      x.force = x.force + by[k].force * e.tip[k];
      x.moment = x.moment + by[k].moment * e.tip[k];
    }
    lift(x, e, to.x);
    const auto turn = [&](const Wrench& shift, Wrench& w) {
      w.force = w.force - times_cross(shift.force, e.position);
      w.moment = w.moment - times_cross(shift.moment, e.position);
    };
    turn(by[velocity], by[omega]);
    by[omega].force = by[omega].force + by[acceleration].force * e.of_omega +
                      by[alpha].force * e.of_turning;
    by[omega].moment = by[omega].moment + by[acceleration].moment * e.of_omega +
                       by[alpha].moment * e.of_turning;
    turn(by[acceleration], by[alpha]);
    for (std::size_t k = 0; k < 4; ++k) lift(by[k], e, to.state[k]);
  }
  static void lift(const Wrench& w, const Factors& e, Column& to) {
    to.force = to.force + w.force;
    to.moment = to.moment + w.moment + cross_times(e.position, w.force);
    to.own = to.own + e.slope.transposed() * w.force + e.turn.transposed() * w.moment;
  }

  /// The same for displacements, which the tip's share but for the unknowns' own.
  static void carry(const Hanging& hanging, const T& pos, Factors& e, Columns& to,
                    Places& places) {
    std::array<Wrench, 2> by;
    const Matrix back = e.rotation.transposed();
    for (std::size_t k = 0; k < 2; ++k) {
      by[k] = {e.rotation * hanging.place[k].force * back,
               e.rotation * hanging.place[k].moment * back};
    }
    e.shift = pos * e.slope;
    e.rotated = pos * e.turn;
    Column x = to.x;
    lift({by[0].force * e.shift + by[1].force * e.rotated,
          by[0].moment * e.shift + by[1].moment * e.rotated},
         e, x);
    put(hanging.placed, x, to.x);
    by[1].force = by[1].force - times_cross(by[0].force, e.position);
    by[1].moment = by[1].moment - times_cross(by[0].moment, e.position);
    for (std::size_t k = 0; k < 2; ++k) lift(by[k], e, places[k]);
  }
  /// Only where there is a load; elsewhere not even the sign of a zero changes.
  template <class M>
  static void put(const T& some, const M& from, M& to) {
    to = where_less(T(0), some, from, to);
  }
  static void put(const T& some, const Column& from, Column& to) {
    put(some, from.force, to.force);
    put(some, from.moment, to.moment);
    put(some, from.own, to.own);
  }

  /// With the load f on a point P that moves with u, A = -df/dx and B = -df/du:
  ///
  ///     dF = phi x f + A (d + phi x P + dP) + B (dv + domega x P + du + phi x u)
  void add_loads(const Material& m, const VariedElement<Kind>& element,
                 const ExactPoint<T>* loads, Factors& e, Columns& to,
                 Places& places) const {
    T some(0);
    Columns all = to;
    VariedWrench<T> wrench;
    for (int k = 0; k < kernel_.points(); ++k) {
      const ExactPoint<T>& at = loads[k];
      if (!any_less(T(0), at.some)) continue;
      some = larger(some, at.some);
      const VariedPoint<T> point = element.point(T(kernel_.at(k)) * m.length);
      const Vec f = element.in_start(at.load.force), p = value_of(point.position);
      const Matrix by_x = element.in_start(at.load.by_x),
                   by_u = element.in_start(at.load.by_u);
      const VariedVec<T> u =
          Vec(e.start.v) + cross(e.start.omega, point.position) + point.velocity;
      const Matrix parts = by_x * parts_of(point.position) + by_u * parts_of(u);
      const VariedVec<T> less =
          with_parts(Vec{} - f, parts.column(0), parts.column(1), parts.column(2));
      wrench.force = wrench.force + less;
      wrench.moment = wrench.moment + cross(point.position, less);
      wrench.unknown = wrench.unknown + point.slope.back(less);
      const Matrix slope = value_of(point.slope).transposed();
      const auto add = [&](const Matrix& force, Column& column) {
        column.force = column.force + force;
        column.moment = column.moment + cross_times(p, force);
        column.own = column.own + slope * force;
      };
      const Matrix levered = times_cross(by_u, p);
      add(by_x, places[0]);
      add(Matrix{} - cross_matrix(f) - times_cross(by_x, p) -
              times_cross(by_u, value_of(u)),
          places[1]);
      add(by_u, all.state[velocity]);
      add(Matrix{} - levered, all.state[omega]);
    }
    all.force = all.force + value_of(wrench.force);
    all.moment = all.moment + value_of(wrench.moment);
    all.unknown = all.unknown + value_of(wrench.unknown);
    put(some, all.force, to.force);
    put(some, all.moment, to.moment);
    put(some, all.unknown, to.unknown);
    put(some,
        {all.x.force + parts_of(wrench.force), all.x.moment + parts_of(wrench.moment),
         all.x.own + parts_of(wrench.unknown)},
        to.x);
    put(some, all.state[velocity], to.state[velocity]);
    put(some, all.state[omega], to.state[omega]);
    e.placed = larger(e.placed, some);
  }

  void eliminate(const Columns& all, Factors& e, Hanging& h) const {
    e.pivot = inverse(all.x.own);
    e.force = all.x.force * e.pivot;
    e.moment = all.x.moment * e.pivot;
    for (std::size_t k = 0; k < 4; ++k) {
      const Column& of = all.state[k];
      e.z[k] = e.pivot * of.own;
      h.state[k] = {of.force - e.force * of.own, of.moment - e.moment * of.own};
    }
    hang(e, all.unknown, h.beta_force, h.beta_moment);
    h.force = all.force;
    h.moment = all.moment;
  }
  static void eliminate(const Places& places, Factors& e, Hanging& h) {
    h.placed = e.placed;
    for (std::size_t k = 0; k < 2; ++k) {
      const Column& of = places[k];
      e.z_of_place[k] = e.pivot * of.own;
      h.place[k] = {of.force - e.force * of.own, of.moment - e.moment * of.own};
    }
  }
  /// Without twist, of the lower right block.
  Matrix inverse(const Matrix& h) const {
    if (kernel_.twist()) return models::inverse(h);
    const Vec &y = h.row[1], &z = h.row[2];
    const T by = T(1) / (y.y * z.z - y.z * z.y), o(0);
    return {{Vec{}, {o, by * z.z, -by * y.z}, {o, -by * z.y, by * y.y}}};
  }
  /// beta from the tip to the start.
  static void hang(Factors& e, const Vec& b, Vec& force, Vec& moment) {
    force = e.rotation * force;
    moment = e.rotation * moment;
    const Vec left = b - e.slope.back(force) - e.turn.back(moment);
    e.u = e.pivot * left;
    moment = moment + cross(e.position, force) + e.moment * left;
    force = force + e.force * left;
  }

  /// From the root, which does not move, to the tip.
  T corrections(const Factors* factors, Vec* correction) const {
    T most(0), finite(0);  // the last: 0 or NaN
    std::array<Vec, 4> s{};
    Vec shift, rotated;
    for (int i = 0; i < kernel_.elements(); ++i) {
      const Factors& e = factors[i];
      Vec x = e.u - e.z[0] * s[0] - e.z[1] * s[1] - e.z[2] * s[2] - e.z[3] * s[3];
      if (any_less(T(0), e.placed)) {
        put(e.placed, x - e.z_of_place[0] * shift - e.z_of_place[1] * rotated, x);
        shift = e.rotation.back(shift + cross(rotated, e.position) + e.shift * x);
        rotated = e.rotation.back(rotated + e.rotated * x);
      }
      correction[i] = x;
      const T all = x.x + x.y + x.z;
      finite += all - all;
      most = larger(larger(most, magnitude(x.x)), larger(magnitude(x.y), magnitude(x.z)));
      const Vec w = s[omega];
      s[acceleration] = s[acceleration] + cross(s[alpha], e.position) + e.of_omega * w;
      s[alpha] = s[alpha] + e.of_turning * w;
      s[velocity] = s[velocity] + cross(w, e.position);
      for (std::size_t k = 0; k < 4; ++k) s[k] = e.rotation.back(s[k] + e.tip[k] * x);
    }
    return most + finite;
  }

  const Kernel& kernel_;
};

}  // namespace tress::models
