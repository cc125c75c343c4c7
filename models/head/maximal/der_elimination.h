#pragma once

#include "contract/system.h"
#include "models/head/maximal/der_joint.h"

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

  /// Of node i + 1 of n.
  T inertia_of_node(Weights w, int i, int n) const {
    return T(i + 1 < n ? 1 : 0.5) * (T(w.acc) * mass + T(w.vel) * drag);
  }
};

/// An edge and the joint before it at a state; rotations in components of the edge's
/// frame.
template <class T>
struct DerPlaced {
  FrameOf<T> frame;
  T length, inverse_length;
  Vec3<T> p;        // dtheta = p . omega
  Matrix3<T> turn;  // from the frame to that of the edge before
  Vec3<T> moment;   // of the joint on the edge
  T tension;
  Vec3<T> force;        // residual of the node at its end, without those of edges
  T turning;            // inertia times theta''
  Symmetric3<T> stiff;  // K: w (edge - edge before) . K (edge - edge before)
};
/// Derivatives of the moment on the edge, ww by its own rotation, wo by that of the edge
/// before, and of the moment on the edge before: ow, oo.
template <class T>
struct DerExactPlaced : DerPlaced<T> {
  Matrix3<T> ww, wo, ow, oo;
};

/// Elimination of an edge with symmetric matrices:
///     omega = own - of_x x + of_turn (rotation of the edge before),
///     sigma = by (own_sigma - sigma_x . x - sigma_omega . omega).
template <class T>
struct DerStiffElimination {
  using Vec = Vec3<T>;
  using Matrix = Matrix3<T>;
  using Symmetric = Symmetric3<T>;
  using Placed = DerPlaced<T>;

  struct Factor {
    Symmetric pivot;  // inverse, of omega
    Matrix of_x, of_turn;
    Vec sigma_x, sigma_omega;
    T by;  // inverse pivot of sigma
    Vec own;
    T own_sigma;
  };

  /// From the tip to the root; right sides as well.
  static void run(int n, const DerMaterial<T>& m, Weights w, const Placed* placed,
                  Factor* factors) {
    Symmetric xx{}, ww{};
    Matrix xw{};
    Vec f_x{}, f_omega{};
    for (int i = n - 1; i >= 0; --i) {
      const Placed& e = placed[i];
      Factor& f = factors[i];
      const T own = m.inertia_of_node(w, i, n);
      xx.xx += own;
      xx.yy += own;
      xx.zz += own;
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
      add_square(h, T(w.acc) * m.inertia, e.p);
      const Vec s_omega{dot(t, c0), dot(t, h1), dot(t, h2)};
      f.by = T(1) / (dot(t, x_t) + T(w.pos) * m.stretch);
      f.sigma_x = x_t;
      f.sigma_omega = s_omega;
      xx = less_square(xx, f.by, x_t);
      h = less_square(h, f.by, s_omega);
      const Vec by = f.by * s_omega;
      const Matrix of_omega{{c0 - by.x * x_t, h1 - by.y * x_t, h2 - by.z * x_t}};
      f.pivot = inverse(h + e.stiff);
      f.of_x = f.pivot * of_omega;
      f.of_turn = f.pivot * full(e.stiff);
      reduce(e, f, e.force, e.turning * e.p + e.moment, e.tension, f_x, f_omega);
      f_omega = e.turn * (f_omega - e.moment);
      if (i == 0) break;
      const Matrix of_x = of_omega.transposed();
      xx = xx - upper(of_x, f.of_x.transposed());
      xw = of_x * f.of_turn * e.turn.transposed();
      // K - K (K + H)^-1 K without cancellation.
      ww = congruent(e.turn, upper(f.of_turn.transposed(), full(h)));
    }
  }

  /// Right sides of an edge's unknowns, given residuals of the node at its end and of
  /// omega and sigma; passes on what is left to the start and to the edge before, in the
  /// edge's components.
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

/// The same with second derivatives; those of friction are not symmetric.
template <class T>
struct DerExactElimination {
  using Vec = Vec3<T>;
  using Matrix = Matrix3<T>;
  using Placed = DerExactPlaced<T>;

  struct Factor {
    Matrix pivot;
    Matrix of_x, of_turn;
    Vec sigma_x, sigma_omega;
    T by;
    Vec own;
    T own_sigma;
    Matrix to_x, to_turn;      // by omega
    Vec x_sigma, omega_sigma;  // by sigma
  };

  static void run(int n, const DerMaterial<T>& m, Weights w, const Placed* placed,
                  Factor* factors) {
    const T o(0), pos(w.pos);
    Matrix xx{}, ww{}, xw{}, wx{};
    Vec f_x{}, f_omega{}, moment_behind{};
    for (int i = n - 1; i >= 0; --i) {
      const Placed& e = placed[i];
      Factor& f = factors[i];
      const T own = m.inertia_of_node(w, i, n);
      xx.row[0].x += own;
      xx.row[1].y += own;
      xx.row[2].z += own;
      const Vec& t = e.frame.e0;
      // Displacement of the end by omega.
      const Matrix lever = Matrix::columns({o, o, o}, -e.length * e.frame.e2,
                                           e.length * e.frame.e1),
                   back = lever.transposed();
      Matrix x_omega = xw + xx * lever, omega_x = wx + back * xx;
      const DerEdgeForm<T> second(e.p, e.inverse_length,
                                  pos * (e.moment - moment_behind));
      Matrix h = ww + back * x_omega + wx * lever + full(second.omega) +
                 dyad(e.p, (T(w.acc) * m.inertia) * e.p);
      const T pull = pos * e.tension * e.length;
      h.row[1].y += pull;
      h.row[2].z += pull;
      f.x_sigma = xx * t;
      f.sigma_x = xx.back(t);
      f.omega_sigma = omega_x * t + second.sigma;
      f.sigma_omega = x_omega.back(t) + second.sigma;
      f.by = T(1) / (dot(t, f.x_sigma) + pos * m.stretch);
      const Vec by_x = f.by * f.sigma_x, by_omega = f.by * f.sigma_omega;
      xx = xx - dyad(f.x_sigma, by_x);
      x_omega = x_omega - dyad(f.x_sigma, by_omega);
      omega_x = omega_x - dyad(f.omega_sigma, by_x);
      h = h - dyad(f.omega_sigma, by_omega);
      f.pivot = inverse(h + e.ww);
      f.of_x = f.pivot * omega_x;
      f.of_turn = T(-1) * (f.pivot * e.wo);
      f.to_x = x_omega;
      f.to_turn = e.ow;
      reduce(e, f, e.force, e.turning * e.p + e.moment, e.tension, f_x, f_omega);
      moment_behind = e.turn * e.moment;
      f_omega = e.turn * f_omega - moment_behind;
      if (i == 0) break;
      const Matrix turn_back = e.turn.transposed();
      xx = xx - x_omega * f.of_x;
      xw = x_omega * f.of_turn * turn_back;
      wx = T(-1) * (e.turn * (e.ow * f.of_x));
      ww = e.turn * (e.oo + e.ow * f.of_turn) * turn_back;
    }
  }

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
};

}  // namespace tress::models
