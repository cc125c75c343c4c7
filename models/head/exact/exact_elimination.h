#pragma once

#include <array>

#include "models/head/reduced_kernel.h"

namespace tress::models {

/// The elimination of ExactKernel in the components of elements' starts, whatever the
/// elements are.
template <class T>
class ExactElimination {
 public:
  /// Vector of these scalars.
  using Vec = Vec3<T>;
  /// Matrix of these scalars.
  using Matrix = Matrix3<T>;
  /// Motion of a frame.
  using Motion = ReducedMotion<T>;

  /// Factors of an element between sweeps.
  struct Factors {
    Motion start;                 // motion of the start
    Matrix rotation;              // of its tip
    Vec position;                 // place of the tip
    Matrix slope, turn;           // rows of J: J^T, in the components of the start
    Matrix of_omega, of_turning;  // omega in the acceleration of the tip
    std::array<Matrix, 4> tip;    // B
    Matrix pivot;                 // H'^-1
    std::array<Matrix, 4> z;      // H'^-1 R'
    Matrix force, moment;         // Y
    Vec u;                        // H'^-1 (b - J beta)
    // Where loads feel displacements, in these lanes 1 and else 0.
    T placed;                          // 1 in lanes that feel displacements
    Matrix shift, rotated;             // their part of B
    std::array<Matrix, 2> z_of_place;  // and of z
  };

  /// Column of states or unknowns: the wrench about the element's start, and the force on
  /// the unknowns.
  struct Column {
    Matrix force, moment, own;  // by the entries of the column
  };
  /// States of a start: `velocity`, `omega`, `acceleration`, `alpha`.
  enum State { velocity, omega, acceleration, alpha };
  /// Columns of an element.
  struct Columns {
    Column x;                     // column of the unknowns
    std::array<Column, 4> state;  // columns of the states
    Vec force, moment, unknown;   // of the residual
  };
  using Places = std::array<Column, 2>;  // of displacements (d, phi)
  struct Wrench {
    Matrix force, moment;  // force and moment
  };
  /// On a tip, in its components.
  struct Hanging {
    std::array<Wrench, 4> state;  // L
    Vec force, moment;            // of the residual
    Vec beta_force, beta_moment;  // wrench of the residual after elimination
    T placed;                     // as Factors::placed
    std::array<Wrench, 2> place;  // L of displacements
  };

  /// Adds the rotor at a tip.
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
  /// Carries columns of displacements to the start of the element. Unknowns change
  /// displacements by `pos` times their effect on the tip.
  static void carry(const Hanging& hanging, const T& pos, const Factors& e, Columns& to,
                    Places& places) {
    std::array<Wrench, 2> by;
    const Matrix back = e.rotation.transposed();
    for (std::size_t k = 0; k < 2; ++k) {
      by[k] = {e.rotation * hanging.place[k].force * back,
               e.rotation * hanging.place[k].moment * back};
    }
    Column x = to.x;
    lift({pos * (by[0].force * e.slope + by[1].force * e.turn),
          pos * (by[0].moment * e.slope + by[1].moment * e.turn)},
         e, x);
    put(hanging.placed, x, to.x);
    by[1].force = by[1].force - times_cross(by[0].force, e.position);
    by[1].moment = by[1].moment - times_cross(by[0].moment, e.position);
    for (std::size_t k = 0; k < 2; ++k) lift(by[k], e, places[k]);
  }
  /// Stores `from` only in lanes with a load; elsewhere not even the sign of a zero
  /// changes.
  template <class M>
  static void put(const T& some, const M& from, M& to) {
    to = where_less(T(0), some, from, to);
  }
  /// Sets a column in lanes where `some` > 0.
  static void put(const T& some, const Column& from, Column& to) {
    put(some, from.force, to.force);
    put(some, from.moment, to.moment);
    put(some, from.own, to.own);
  }

  /// Eliminates the unknowns of an element.
  static void eliminate(const Columns& all, bool twist, Factors& e, Hanging& h) {
    e.pivot = inverse(all.x.own, twist);
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
  /// Eliminates the displacements.
  static void eliminate(const Places& places, const T& pos, Factors& e, Hanging& h) {
    h.placed = e.placed;
    e.shift = pos * e.slope;
    e.rotated = pos * e.turn;
    for (std::size_t k = 0; k < 2; ++k) {
      const Column& of = places[k];
      e.z_of_place[k] = e.pivot * of.own;
      h.place[k] = {of.force - e.force * of.own, of.moment - e.moment * of.own};
    }
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

  /// x, from the root, which does not move, to the tip. Returns its largest entry per
  /// lane, NaN unless all are finite.
  static T corrections(int elements, const Factors* factors, Vec* correction) {
    T most(0), finite(0);  // the last: 0 or NaN
    std::array<Vec, 4> s{};
    Vec shift, rotated;
    for (int i = 0; i < elements; ++i) {
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

 private:
  static void lift(const Wrench& w, const Factors& e, Column& to) {
    to.force = to.force + w.force;
    to.moment = to.moment + w.moment + cross_times(e.position, w.force);
    to.own = to.own + e.slope.transposed() * w.force + e.turn.transposed() * w.moment;
  }

  /// Without twist, of the lower right block.
  static Matrix inverse(const Matrix& h, bool twist) {
    if (twist) return tress::inverse(h);
    const Vec &y = h.row[1], &z = h.row[2];
    const T by = T(1) / (y.y * z.z - y.z * z.y), o(0);
    return {{Vec{}, {o, by * z.z, -by * y.z}, {o, -by * z.y, by * y.y}}};
  }
};

}  // namespace tress::models
