#pragma once

#include "models/maximal/kernel/der_joint.h"

namespace tress::models {

/// An edge and the joint before it at a state; rotations in components of the edge's
/// frame.
template <class T>
struct DerPlaced {
  FrameOf<T> frame;          // frame of the edge
  T length, inverse_length;  // length and its inverse
  Vec3<T> p;                 // dtheta = p . omega
  Matrix3<T> turn;           // from the frame to that of the edge before
  Vec3<T> moment;            // of the joint on the edge
  T tension;                 // force along the edge
  Symmetric3<T> stiff;       // K: w (edge - edge before) . K (edge - edge before)

  /// Returns the force on the edge's end, in world components, that is work-conjugate to
  /// its tension and a moment on the edge. It satisfies moment . omega = force . de +
  /// torque dtheta, where the torque is the moment along the edge.
  Vec3<T> force_by(const Vec3<T>& on_it) const {
    const T along = on_it.x;
    return tension * frame.e0 + (inverse_length * (on_it.z - along * p.z)) * frame.e1 -
           (inverse_length * (on_it.y - along * p.y)) * frame.e2;
  }
  /// Change of the vector along it.
  Vec3<T> change(const Vec3<T>& omega, const T& sigma) const {
    return sigma * frame.e0 + (length * omega.z) * frame.e1 -
           (length * omega.y) * frame.e2;
  }
};
/// Derivatives of the moment on the edge, ww by its own rotation, wo by that of the edge
/// before, and of the moment on the edge before: ow, oo.
template <class T>
struct DerExactPlaced : DerPlaced<T> {
  Matrix3<T> ww, wo, ow, oo;  // derivatives, as above
};

/// Rotation of an edge and its lengthening.
template <class T>
struct DerChange {
  Vec3<T> omega;  // rotation, in components of the edge's frame
  T sigma;        // lengthening
};
/// Computes the change of an edge whose start moves by x while the edge before rotates by
/// `before`; the first edge has none before it.
template <class T, class Factor>
DerChange<T> der_change(const DerPlaced<T>& e, const Factor& f, bool first,
                        const Vec3<T>& x, const Vec3<T>& before) {
  Vec3<T> own = f.own - f.of_x * x;
  if (!first) own = own + f.of_turn * e.turn.back(before);
  return {own, f.by * (f.own_sigma - dot(f.sigma_x, x) - dot(f.sigma_omega, own))};
}

/// Elimination of an edge with symmetric matrices:
///     omega = own - of_x x + of_turn (rotation of the edge before),
///     sigma = by (own_sigma - sigma_x . x - sigma_omega . omega).
template <class T>
struct DerStiffElimination {
  /// Vector of these scalars.
  using Vec = Vec3<T>;
  /// Matrix of these scalars.
  using Matrix = Matrix3<T>;
  /// Symmetric matrix of these scalars.
  using Symmetric = Symmetric3<T>;
  /// Geometry and stresses at a state.
  using Placed = DerPlaced<T>;

  /// Factors of an edge.
  struct Factor {
    Symmetric pivot;           // inverse, of omega
    Matrix of_x, of_turn;      // omega by x and by the rotation of the edge before
    Vec sigma_x, sigma_omega;  // sigma by x and by omega
    T by;                      // inverse pivot of sigma
    Vec own;                   // omega of the residual
    T own_sigma;               // sigma of the residual
  };

  /// Quadratic form of all that follows an edge, by the position x of its start and the
  /// rotation w of the edge before. Before eliminate() it includes the inertia of the
  /// node at the edge's end.
  struct Beyond {
    Symmetric xx{}, ww{};  // blocks on the diagonal
    Matrix xw{};           // block of x and w

    /// Adds the mass of the node at the edge's end.
    void add_inertia(const T& mass) {
      xx.xx += mass;
      xx.yy += mass;
      xx.zz += mass;
    }
    /// Adds the derivatives of loads on that node.
    void add_block(const Symmetric& of_load) { xx = xx + of_load; }
  };

  /// `along`: stiffness against stretching; `turning`: inertia of the angle, both
  /// weighted.
  template <class Pivots>
  static void eliminate(const Placed& e, bool first, const T& along, const T& turning,
                        Beyond& beyond, Factor& f, Pivots&& pivots) {
    Symmetric &xx = beyond.xx, &ww = beyond.ww;
    Matrix& xw = beyond.xw;
    // The end's displacement is x + sigma t + L (omega_2 m1 - omega_1 m2).
    const Vec& t = e.frame.e0;
    const Vec lever1 = e.length * e.frame.e1, lever2 = e.length * e.frame.e2;
    const Vec x_t = xx * t, x_1 = xx * lever1, x_2 = xx * lever2;
    const Vec c0 = xw.column(0), c1 = xw.column(1), c2 = xw.column(2);
    const Vec h1 = c1 - x_2, h2 = c2 + x_1;  // of x and omega
    Symmetric h;
    h.xx = ww.xx;
    h.xy = ww.xy - dot(lever2, c0);
    h.xz = ww.xz + dot(lever1, c0);
    h.yy = ww.yy - dot(lever2, c1 + h1);
    h.yz = ww.yz - dot(lever2, h2) + dot(lever1, c1);
    h.zz = ww.zz + dot(lever1, c2 + h2);
    add_square(h, turning, e.p);
    const Vec s_omega{dot(t, c0), dot(t, h1), dot(t, h2)};
    const T pivot = dot(t, x_t) + along;
    pivots(pivot, pivot);
    f.by = T(1) / pivot;
    f.sigma_x = x_t;
    f.sigma_omega = s_omega;
    xx = less_square(xx, f.by, x_t);
    h = less_square(h, f.by, s_omega);
    const Vec by = f.by * s_omega;
    const Matrix of_omega{{c0 - by.x * x_t, h1 - by.y * x_t, h2 - by.z * x_t}};
    const Symmetric whole = h + e.stiff;
    check(full(whole), pivots);
    f.pivot = inverse(whole);
    f.of_x = f.pivot * of_omega;
    f.of_turn = f.pivot * full(e.stiff);
    if (first) return;  // the root does not move
    const Matrix of_x = of_omega.transposed();
    xx = xx - upper(of_x, f.of_x.transposed());
    xw = of_x * f.of_turn * e.turn.transposed();
    // K - K (K + H)^-1 K without cancellation.
    ww = congruent(e.turn, upper(f.of_turn.transposed(), full(h)));
  }

  /// Reduces the right-hand sides of an edge's unknowns, given residuals of the node at
  /// its end and of omega and sigma. Passes the remainder to the start and to the edge
  /// before, in the edge's components.
  static void reduce(const Placed& e, Factor& f, const Vec& force, const Vec& moment,
                     const T& tension, Vec& f_x, Vec& f_omega) {
    f_x = f_x + force;
    const T f1 = e.length * dot(e.frame.e1, f_x), f2 = e.length * dot(e.frame.e2, f_x);
    f.own_sigma = dot(e.frame.e0, f_x) + tension;
    const T by = f.by * f.own_sigma;
    const Vec tau = f_omega + moment + Vec{T(0), -f2, f1} - by * f.sigma_omega;
    f.own = f.pivot * tau;
    f_x = f_x - by * f.sigma_x - f.of_x.back(tau);
    f_omega = f.of_turn.back(tau);
  }
};

/// Elimination of an edge with second derivatives; those of friction are not symmetric.
template <class T>
struct DerExactElimination {
  /// Vector of these scalars.
  using Vec = Vec3<T>;
  /// Matrix of these scalars.
  using Matrix = Matrix3<T>;
  /// Geometry and stresses at a state.
  using Placed = DerExactPlaced<T>;

  /// Factors of an edge.
  struct Factor {
    Matrix pivot;              // inverse, of omega
    Matrix of_x, of_turn;      // omega by x and by the rotation of the edge before
    Vec sigma_x, sigma_omega;  // sigma by x and by omega
    T by;                      // inverse pivot of sigma
    Vec own;                   // omega of the residual
    T own_sigma;               // sigma of the residual
    Matrix to_x, to_turn;      // by omega
    Vec x_sigma, omega_sigma;  // by sigma
  };

  /// Matrix of all that follows an edge.
  struct Beyond {
    Matrix xx{}, ww{}, xw{}, wx{};  // blocks of x and w

    /// Adds the mass of the node at the edge's end.
    void add_inertia(const T& mass) {
      xx.row[0].x += mass;
      xx.row[1].y += mass;
      xx.row[2].z += mass;
    }
    /// Adds the derivatives of loads on that node.
    void add_block(const Matrix& of_load) { xx = xx + of_load; }
  };

  /// `pos`: weight of positions; `moment`: of all joints on the edge; `tension`: with
  /// which it resists turns.
  template <class Pivots>
  static void eliminate(const Placed& e, bool first, const T& pos, const T& along,
                        const T& turning, const Vec& moment, const T& tension,
                        Beyond& beyond, Factor& f, Pivots&& pivots) {
    const T o(0);
    Matrix &xx = beyond.xx, &ww = beyond.ww, &xw = beyond.xw, &wx = beyond.wx;
    const Vec& t = e.frame.e0;
    // Displacement of the end by omega.
    const Matrix lever = Matrix::columns({o, o, o}, -e.length * e.frame.e2,
                                         e.length * e.frame.e1),
                 back = lever.transposed();
    Matrix x_omega = xw + xx * lever, omega_x = wx + back * xx;
    const DerEdgeForm<T> second(e.p, e.inverse_length, pos * moment);
    Matrix h =
        ww + back * x_omega + wx * lever + full(second.omega) + dyad(e.p, turning * e.p);
    const T pull = pos * tension * e.length;
    h.row[1].y += pull;
    h.row[2].z += pull;
    f.x_sigma = xx * t;
    f.sigma_x = xx.back(t);
    f.omega_sigma = omega_x * t + second.sigma;
    f.sigma_omega = x_omega.back(t) + second.sigma;
    const T pivot = dot(t, f.x_sigma) + along;
    pivots(pivot, pivot);
    f.by = T(1) / pivot;
    const Vec by_x = f.by * f.sigma_x, by_omega = f.by * f.sigma_omega;
    xx = xx - dyad(f.x_sigma, by_x);
    x_omega = x_omega - dyad(f.x_sigma, by_omega);
    omega_x = omega_x - dyad(f.omega_sigma, by_x);
    h = h - dyad(f.omega_sigma, by_omega);
    const Matrix whole = h + e.ww;
    check(whole, pivots);
    f.pivot = inverse(whole);
    f.of_x = f.pivot * omega_x;
    f.of_turn = T(-1) * (f.pivot * e.wo);
    f.to_x = x_omega;
    f.to_turn = e.ow;
    if (first) return;
    const Matrix turn_back = e.turn.transposed();
    xx = xx - x_omega * f.of_x;
    xw = x_omega * f.of_turn * turn_back;
    wx = T(-1) * (e.turn * (e.ow * f.of_x));
    ww = e.turn * (e.oo + e.ow * f.of_turn) * turn_back;
  }

  /// Eliminates the residual of an edge.
  static void reduce(const Placed& e, Factor& f, const Vec& force, const Vec& moment,
                     const T& tension, Vec& f_x, Vec& f_omega) {
    f_x = f_x + force;
    const T f1 = e.length * dot(e.frame.e1, f_x), f2 = e.length * dot(e.frame.e2, f_x);
    f.own_sigma = dot(e.frame.e0, f_x) + tension;
    const T by = f.by * f.own_sigma;
    f.own = f.pivot * (f_omega + moment + Vec{T(0), -f2, f1} - by * f.omega_sigma);
    f_x = f_x - by * f.x_sigma - f.to_x * f.own;
    f_omega = Vec{} - f.to_turn * f.own;
  }

  /// reduce() for the transposed matrix.
  static void reduce_transposed(const Placed& e, Factor& f, const Vec& force,
                                const Vec& moment, const T& tension, Vec& f_x,
                                Vec& f_omega) {
    f_x = f_x + force;
    const T f1 = e.length * dot(e.frame.e1, f_x), f2 = e.length * dot(e.frame.e2, f_x);
    f.own_sigma = dot(e.frame.e0, f_x) + tension;
    const T by = f.by * f.own_sigma;
    f.own = f_omega + moment + Vec{T(0), -f2, f1} - by * f.sigma_omega;
    f_x = f_x - by * f.sigma_x - f.of_x.back(f.own);
    f_omega = f.of_turn.back(f.own);
  }
  /// der_change() for the transposed matrix.
  static DerChange<T> change_transposed(const Placed& e, const Factor& f, bool first,
                                        const Vec& x, const Vec& before) {
    Vec own = f.own - f.to_x.back(x);
    if (!first) own = own - f.to_turn.back(e.turn.back(before));
    own = f.pivot.back(own);
    return {own, f.by * (f.own_sigma - dot(f.x_sigma, x) - dot(f.omega_sigma, own))};
  }
};

}  // namespace tress::models
