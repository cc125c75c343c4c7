#pragma once

#include <array>

#include "models/head/reduced_kernel.h"

namespace tress::models {

/// The elimination of ExactKernel in the components of elements' starts, whatever the
/// elements are: of `functions` times three unknowns each.
template <class T, std::size_t functions = 1>
class ExactElimination {
 public:
  /// One for each function of arc length that the unknowns weight.
  template <class X>
  using Each = std::array<X, functions>;
  /// Vector of these scalars.
  using Vec = Vec3<T>;
  /// Matrix of these scalars.
  using Matrix = Matrix3<T>;
  /// Motion of a frame.
  using Motion = ReducedMotion<T>;

  /// Factors of an element between sweeps.
  struct Factors {
    Motion start;                     // motion of the start
    Matrix rotation;                  // of its tip
    Vec position;                     // place of the tip
    Each<Matrix> slope, turn;         // rows of J: J^T, in the components of the start
    Matrix of_omega, of_turning;      // omega in the acceleration of the tip
    std::array<Each<Matrix>, 4> tip;  // B
    Each<Each<Matrix>> pivot;         // H'^-1
    std::array<Each<Matrix>, 4> z;    // H'^-1 R'
    Each<Matrix> force, moment;       // Y
    Each<Vec> u;                      // H'^-1 (b - J beta)
    // Where loads feel displacements, in these lanes 1 and else 0.
    T placed;                                // 1 in lanes that feel displacements
    Each<Matrix> shift, rotated;             // their part of B
    std::array<Each<Matrix>, 2> z_of_place;  // and of z
  };

  /// Column of states or unknowns: the wrench about the element's start, and the force on
  /// the unknowns.
  struct Column {
    Matrix force, moment;  // by the entries of the column
    Each<Matrix> own;      // by the entries of the column
  };
  /// States of a start: `velocity`, `omega`, `acceleration`, `alpha`.
  enum State { velocity, omega, acceleration, alpha };
  /// Columns of an element.
  struct Columns {
    Each<Column> x;               // columns of the unknowns
    std::array<Column, 4> state;  // columns of the states
    Vec force, moment;            // of the residual
    Each<Vec> unknown;            // of the residual
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
    for (std::size_t f = 0; f < functions; ++f) {
      Wrench x{by[0].force * e.tip[0][f], by[0].moment * e.tip[0][f]};
      for (std::size_t k = 1; k < 4; ++k) {
        x.force = x.force + by[k].force * e.tip[k][f];
        x.moment = x.moment + by[k].moment * e.tip[k][f];
      }
      lift(x, e, to.x[f]);
    }
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
    for (std::size_t f = 0; f < functions; ++f) {
      Column x = to.x[f];
      lift({pos * (by[0].force * e.slope[f] + by[1].force * e.turn[f]),
            pos * (by[0].moment * e.slope[f] + by[1].moment * e.turn[f])},
           e, x);
      put(hanging.placed, x, to.x[f]);
    }
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
    for (std::size_t f = 0; f < functions; ++f) put(some, from.own[f], to.own[f]);
  }

  /// Eliminates the unknowns of an element.
  static void eliminate(const Columns& all, bool twist, Factors& e, Hanging& h) {
    invert(all.x, twist, e.pivot);
    for (std::size_t f = 0; f < functions; ++f) {
      e.force[f] = all.x[0].force * e.pivot[0][f];
      e.moment[f] = all.x[0].moment * e.pivot[0][f];
      for (std::size_t g = 1; g < functions; ++g) {
        e.force[f] = e.force[f] + all.x[g].force * e.pivot[g][f];
        e.moment[f] = e.moment[f] + all.x[g].moment * e.pivot[g][f];
      }
    }
    for (std::size_t k = 0; k < 4; ++k) {
      e.z[k] = by_pivot(e, all.state[k].own);
      h.state[k] = passed(e, all.state[k]);
    }
    hang(e, all.unknown, h.beta_force, h.beta_moment);
    h.force = all.force;
    h.moment = all.moment;
  }
  /// Eliminates the displacements.
  static void eliminate(const Places& places, const T& pos, Factors& e, Hanging& h) {
    h.placed = e.placed;
    for (std::size_t f = 0; f < functions; ++f) {
      e.shift[f] = pos * e.slope[f];
      e.rotated[f] = pos * e.turn[f];
    }
    for (std::size_t k = 0; k < 2; ++k) {
      e.z_of_place[k] = by_pivot(e, places[k].own);
      h.place[k] = passed(e, places[k]);
    }
  }
  /// beta from the tip to the start.
  static void hang(Factors& e, const Each<Vec>& b, Vec& force, Vec& moment) {
    force = e.rotation * force;
    moment = e.rotation * moment;
    Each<Vec> left;
    for (std::size_t f = 0; f < functions; ++f) {
      left[f] = b[f] - e.slope[f].back(force) - e.turn[f].back(moment);
    }
    e.u = by_pivot(e, left);
    moment = moment + cross(e.position, force);
    for (std::size_t f = 0; f < functions; ++f) {
      moment = moment + e.moment[f] * left[f];
      force = force + e.force[f] * left[f];
    }
  }

  /// x, from the root, which does not move, to the tip. Returns its largest entry per
  /// lane, NaN unless all are finite.
  static T corrections(int elements, const Factors* factors, Each<Vec>* correction) {
    T most(0), finite(0);  // the last: 0 or NaN
    std::array<Vec, 4> s{};
    Vec shift, rotated;
    for (int i = 0; i < elements; ++i) {
      const Factors& e = factors[i];
      Each<Vec> all;
      for (std::size_t f = 0; f < functions; ++f) {
        all[f] = e.u[f] - e.z[0][f] * s[0] - e.z[1][f] * s[1] - e.z[2][f] * s[2] -
                 e.z[3][f] * s[3];
      }
      if (any_less(T(0), e.placed)) {
        for (std::size_t f = 0; f < functions; ++f) {
          put(e.placed,
              all[f] - e.z_of_place[0][f] * shift - e.z_of_place[1][f] * rotated, all[f]);
        }
        shift = shift + cross(rotated, e.position);
        for (std::size_t f = 0; f < functions; ++f) {
          shift = shift + e.shift[f] * all[f];
          rotated = rotated + e.rotated[f] * all[f];
        }
        shift = e.rotation.back(shift);
        rotated = e.rotation.back(rotated);
      }
      correction[i] = all;
      for (const Vec& x : all) {
        const T sum = x.x + x.y + x.z;
        finite += sum - sum;
        most =
            larger(larger(most, magnitude(x.x)), larger(magnitude(x.y), magnitude(x.z)));
      }
      const Vec w = s[omega];
      s[acceleration] = s[acceleration] + cross(s[alpha], e.position) + e.of_omega * w;
      s[alpha] = s[alpha] + e.of_turning * w;
      s[velocity] = s[velocity] + cross(w, e.position);
      for (std::size_t k = 0; k < 4; ++k) {
        for (std::size_t f = 0; f < functions; ++f) s[k] = s[k] + e.tip[k][f] * all[f];
        s[k] = e.rotation.back(s[k]);
      }
    }
    return most + finite;
  }

 private:
  static void lift(const Wrench& w, const Factors& e, Column& to) {
    to.force = to.force + w.force;
    to.moment = to.moment + w.moment + cross_times(e.position, w.force);
    for (std::size_t f = 0; f < functions; ++f) {
      to.own[f] = to.own[f] + e.slope[f].transposed() * w.force +
                  e.turn[f].transposed() * w.moment;
    }
  }
  /// H'^-1 x.
  template <class X>
  static Each<X> by_pivot(const Factors& e, const Each<X>& x) {
    Each<X> all;
    for (std::size_t f = 0; f < functions; ++f) {
      all[f] = e.pivot[f][0] * x[0];
      for (std::size_t g = 1; g < functions; ++g) all[f] = all[f] + e.pivot[f][g] * x[g];
    }
    return all;
  }
  /// Returns the wrench that a column passes on after the unknowns are eliminated.
  static Wrench passed(const Factors& e, const Column& of) {
    Wrench w{of.force, of.moment};
    for (std::size_t f = 0; f < functions; ++f) {
      w.force = w.force - e.force[f] * of.own[f];
      w.moment = w.moment - e.moment[f] * of.own[f];
    }
    return w;
  }
  /// H'^-1, of two functions by blocks.
  static void invert(const Each<Column>& x, bool twist, Each<Each<Matrix>>& to) {
    const Matrix first = inverse(x[0].own[0], twist);
    if constexpr (functions == 1) {
      to[0][0] = first;
    } else {
      // By [a b; c d]; s = d - c a^-1 b.
      const Matrix &b = x[1].own[0], &c = x[0].own[1];
      const Matrix across = first * b, back = c * first;
      const Matrix second = inverse(x[1].own[1] - c * across, twist);
      const Matrix o = Matrix{} - across * second;
      to[1][1] = second;
      to[0][1] = o;
      to[1][0] = Matrix{} - second * back;
      to[0][0] = first - o * back;
    }
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
