#pragma once

#include "models/head/exact/exact_elimination.h"
#include "models/head/exact/varied_element.h"

namespace tress::models {

/// Inertia of an element by the state of its start, and motion of its tip by that state,
/// for elements of `functions` times three unknowns.
template <class T, std::size_t functions>
class ExactInertia {
  using Vec = Vec3<T>;
  using Matrix = Matrix3<T>;
  using Elimination = ExactElimination<T, functions>;

 public:
  /// States of a start.
  using State = typename Elimination::State;

  /// Returns x to omega x (x x p) + x x (omega x p + 2 u).
  static Matrix turning_with(const Vec& omega, const Vec& p, const Vec& u) {
    Matrix all = dyad(omega, p) - dyad(T(2) * p, omega) - cross_matrix(T(2) * u);
    const T along = dot(omega, p);
    all.row[0].x += along;
    all.row[1].y += along;
    all.row[2].z += along;
    return all;
  }

  /// The element's mass, drag, and centrifugal and Coriolis forces by state.
  static void add(const ReducedMaterial<T>& m, const ReducedMotion<T>& from,
                  const ElementSums<T, functions>& sums,
                  typename Elimination::Columns& to) {
    const Matrix lever = cross_matrix(sums.first);
    const Matrix second = less_than_trace(full(sums.second));
    const auto add = [&](const T& by, State shift, State turn) {
      auto &shifts = to.state[shift], &turns = to.state[turn];
      shifts.force = times_one(by * sums.one);
      shifts.moment = by * lever;
      turns.force = T(-1) * (by * lever);
      turns.moment = by * second;
      for (std::size_t f = 0; f < functions; ++f) {
        shifts.own[f] = by * sums.momentum[f];
        turns.own[f] = by * sums.spin[f];
      }
    };
    add(m.drag, Elimination::velocity, Elimination::omega);
    add(m.density, Elimination::acceleration, Elimination::alpha);
    const Vec& w = from.omega;
    auto& by_omega = to.state[Elimination::omega];
    by_omega.force = by_omega.force + m.density * turning_with(w, sums.first, sums.moved);
    by_omega.moment = by_omega.moment + m.density * (cross_matrix(sums.second * w) -
                                                     cross_times(w, full(sums.second)) +
                                                     T(2) * less_than_trace(sums.moving));
    for (std::size_t f = 0; f < functions; ++f) {
      by_omega.own[f] = by_omega.own[f] + m.density * sums.convective[f];
    }
  }

  /// Returns the matrix with this diagonal.
  static Matrix diagonal(const Vec& x) {
    const T o(0);
    return {{{x.x, o, o}, {o, x.y, o}, {o, o, x.z}}};
  }

 private:
  static Matrix times_one(const T& x) { return diagonal({x, x, x}); }
  /// (trace m) I - m.
  static Matrix less_than_trace(const Matrix& m) {
    return times_one(m.row[0].x + m.row[1].y + m.row[2].z) - m;
  }
};

/// The linearised equations of one element for ExactKernel: how its tip moves, and the
/// wrenches and forces on unknowns by the state of its start and its unknowns.
template <class Kind>
class ExactElement {
 public:
  /// Kernel of the sweeps along a strand.
  using Kernel = ReducedKernel<Kind>;
  /// Scalar: a number, or a pack of SIMD lanes.
  using T = typename Kind::Real;
  /// Vector of these scalars.
  using Vec = Vec3<T>;
  /// Matrix of these scalars.
  using Matrix = Matrix3<T>;
  /// Data of an element that steps do not change.
  using Material = ReducedMaterial<T>;
  /// Motion of a frame.
  using Motion = ReducedMotion<T>;
  /// Elimination of an element.
  using Elimination = ExactElimination<T>;
  /// Factors of an element.
  using Factors = typename Elimination::Factors;
  /// Column of an element's matrix.
  using Column = typename Elimination::Column;
  /// Columns of an element.
  using Columns = typename Elimination::Columns;
  /// Columns of displacements.
  using Places = typename Elimination::Places;
  /// Response of all that hangs on a tip.
  using Hanging = typename Elimination::Hanging;

  /// Prepares the equations of an element at a state.
  ExactElement(const Kernel& kernel, const Material& m, Weights w, const Vec& q,
               const Vec& v, const Vec& a, const typename Kind::Kept& /*kept*/)
      : kernel_(kernel), m_(m), pos_(w.pos), element_(m, w, q, v, a) {}

  /// Computes the element's own factors with the wrench on its tip: A, B, C, D, R and H.
  void own(const Hanging& hanging, Factors& e, Columns& to) const {
    const Motion& from = e.start;
    const VariedTip<T> tip = element_.tip();
    e.rotation = tip.rotation;
    e.position = value_of(tip.position);
    e.slope[0] = value_of(tip.slope);
    e.turn[0] = value_of(tip.turn);
    // By dq the tip turns by theta.
    const Matrix theta = pos_ * e.turn[0];
    move_tip(from, tip, theta, e);
    const auto turned = [&](const Vec& x) {
      return with_parts(x, cross(theta.column(0), x), cross(theta.column(1), x),
                        cross(theta.column(2), x));
    };
    const VariedVec<T> force = turned(e.rotation * hanging.force),
                       moment = turned(e.rotation * hanging.moment);
    ElementSums<T> sums;
    const VariedWrench<T> inertial = element_.inertial(kernel_, from, sums);
    const VariedVec<T> all_force = inertial.force + force,
                       all_moment = inertial.moment + moment + cross(tip.position, force),
                       unknown = inertial.unknown + tip.slope.back(force) +
                                 tip.turn.back(moment);
    to.force = value_of(all_force);
    to.moment = value_of(all_moment);
    to.unknown[0] = value_of(unknown);
    to.x[0] = {parts_of(all_force), parts_of(all_moment), {parts_of(unknown)}};
    Inertia::add(m_, from, sums, to);
  }

  /// Elastic and viscous moments.
  static void add_bending(const typename Kernel::Bending& bending, Columns& to) {
    to.unknown[0] = to.unknown[0] + bending.moment;
    to.x[0].own[0] = to.x[0].own[0] + Inertia::diagonal(bending.tangent);
  }

  /// Adds the loads on the element's points. With the load f on a point P that moves with
  /// u, A = -df/dx and B = -df/du:
  ///
  ///     dF = phi x f + A (d + phi x P + dP) + B (dv + domega x P + du + phi x u)
  void add_loads(const ExactPoint<T>* loads, Factors& e, Columns& to,
                 Places& places) const {
    T some(0);
    Columns all = to;
    VariedWrench<T> wrench;
    for (int k = 0; k < kernel_.points(); ++k) {
      const ExactPoint<T>& at = loads[k];
      if (!any_less(T(0), at.some)) continue;
      some = larger(some, at.some);
      const VariedPoint<T> point = element_.point(T(kernel_.at(k)) * m_.length);
      const Vec f = element_.in_start(at.load.force), p = value_of(point.position);
      const Matrix by_x = element_.in_start(at.load.by_x),
                   by_u = element_.in_start(at.load.by_u);
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
        column.own[0] = column.own[0] + slope * force;
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
    all.unknown[0] = all.unknown[0] + value_of(wrench.unknown);
    Elimination::put(some, all.force, to.force);
    Elimination::put(some, all.moment, to.moment);
    Elimination::put(some, all.unknown[0], to.unknown[0]);
    const Column& x = all.x[0];
    Elimination::put(some,
                     Column{x.force + parts_of(wrench.force),
                            x.moment + parts_of(wrench.moment),
                            {x.own[0] + parts_of(wrench.unknown)}},
                     to.x[0]);
    Elimination::put(some, all.state[velocity], to.state[velocity]);
    Elimination::put(some, all.state[omega], to.state[omega]);
    e.placed = larger(e.placed, some);
  }

 private:
  using Inertia = ExactInertia<T, 1>;
  using State = typename Elimination::State;
  static constexpr State velocity = Elimination::velocity, omega = Elimination::omega;

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
    e.tip[0][0] = columns(v);
    e.tip[1][0] = columns(w);
    e.tip[2][0] = columns(a);
    e.tip[3][0] = columns(spin);
    e.of_omega = Inertia::turning_with(from.omega, e.position, value_of(tip.velocity));
    e.of_turning = cross_matrix(Vec{} - value_of(tip.turning));
  }

  const Kernel& kernel_;
  const Material& m_;
  T pos_;
  VariedElement<Kind> element_;
};

}  // namespace tress::models
