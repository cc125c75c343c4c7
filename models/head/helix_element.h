#pragma once

#include <array>

#include "math/dual.h"
#include "math/helix.h"
#include "math/matrix3.h"

namespace tress::models {

/// Functions of math/helix.h at arc length s <= length, for kernels whose lanes are
/// strands. The formula of a lane, and its code, do not depend on its neighbours, so
/// results are bit-identical for any number of lanes. The series have 9 terms, or 6 in
/// single precision, for elements that wind by 1.5 rad at most; beyond it
/// models/head/long_windings.h.
template <class T>
class LaneFunctions {
 public:
  LaneFunctions(const Vec3<T>& kappa, const T& length)
      : x2_(dot(kappa, kappa)),
        winding_(x2_ * length * length),
        short_(all_up_to(winding_, most)) {}

  [[gnu::always_inline]] HelixFunctions<T> at(const T& s) const {
    HelixFunctions<T> f = helix::series<few>(s, x2_);
    if (!short_) [[unlikely]] {
      const HelixFunctions<Numbers> all =
          longer(s.numbers(), x2_.numbers(), winding_.numbers());
      for (std::size_t i = 0; i < std::size(HelixFunctions<T>::all); ++i) {
        T& own = f.*HelixFunctions<T>::all[i];
        own = where_up_to(winding_, most, own, T(all.*HelixFunctions<Numbers>::all[i]));
      }
    }
    return f;
  }
  const T& x2() const { return x2_; }

 private:
  using Numbers = std::array<typename T::Scalar, T::lanes>;

  /// Six terms leave 1e-9 at 1.5 rad.
  static constexpr int few = sizeof(typename T::Scalar) == sizeof(double) ? 9 : 6;
  static constexpr auto most = static_cast<typename T::Scalar>(helix::short_end);

  /// Computes the functions for lanes that wind by more. A separate function with
  /// arguments by value, since variables that a call might change could not stay in
  /// registers. Arguments are arrays, which all instruction sets pass in the same way
  /// (math/instructions.h). Defined in models/head/long_windings.h.
  [[gnu::noinline]] static HelixFunctions<Numbers> longer(Numbers arc, Numbers squared,
                                                          Numbers angle);

  T x2_, winding_;
  bool short_;
};

/// A vector along an element: constants weighted with the functions of arc length.
template <class T>
struct AlongHelix {
  Vec3<T> one, s, A, B, A1, B1, A2, B2;

  Vec3<T> at(const T& arc, const HelixFunctions<T>& f) const {
    return one + arc * s + f.A * A + f.B * B + f.A1 * A1 + f.B1 * B1 + f.A2 * A2 +
           f.B2 * B2;
  }
  /// Computes at() without its constant and linear parts.
  Vec3<T> by_functions(const HelixFunctions<T>& f) const {
    return f.A * A + f.B * B + f.A1 * A1 + f.B1 * B1 + f.A2 * A2 + f.B2 * B2;
  }
  /// Returns the vector by which at() changes, times kappa . dkappa, through the
  /// functions.
  Vec3<T> slope(const HelixFunctions<T>& f) const {
    return f.A1 * A + f.B1 * B + f.A2 * A1 + f.B2 * B1 + f.A3 * A2 + f.B3 * B2;
  }
};

/// Element of constant Darboux vector kappa that changes at the rate kappa', in the
/// components of its start. Implements models/reduced/helix.h for lanes, with the
/// products of e0 = (1, 0, 0) written out. With u = kappa x e0 and z = kappa x u
///
///     P = s e0 + A u + B z,    dP/dkappa_j = kappa_j r + B l_j + A m_j,
///     r = A1 u + B1 z,  l_j = e_j x u + kappa x (e_j x e0),  m_j = e_j x e0.
///
/// All sums over an element are therefore combinations of constant vectors. Only the
/// functions and their products have to be summed over its points.
template <class T>
class HelixElement {
 public:
  using Vec = Vec3<T>;
  using Matrix = Matrix3<T>;
  using Number = typename ConstantOf<T>::Type;

  HelixElement(const Vec& kappa, const Vec& rate)
      : k_(kappa),
        v_(rate),
        u_{T(0), kappa.z, -kappa.y},
        z_{-(kappa.y * kappa.y + kappa.z * kappa.z), kappa.x * kappa.y,
           kappa.x * kappa.z},
        k_v_(dot(kappa, rate)),
        v_v_(dot(rate, rate)),
        u_v_{T(0), rate.z, -rate.y},
        z_v_(cross(rate, u_) + cross(kappa, u_v_)),
        l_v_(along_l(rate)) {}

  const Vec& k() const { return k_; }
  const Vec& u() const { return u_; }
  const Vec& z() const { return z_; }

  Vec position(const T& s, const HelixFunctions<T>& f) const {
    return {s + f.B * z_.x, f.A * u_.y + f.B * z_.y, f.A * u_.z + f.B * z_.z};
  }
  Matrix slope(const HelixFunctions<T>& f) const {
    const Vec r{f.B1 * z_.x, f.A1 * u_.y + f.B1 * z_.y, f.A1 * u_.z + f.B1 * z_.z};
    const T bx = f.B * k_.x, by = f.B * k_.y, bz = f.B * k_.z;
    return Matrix::columns(
        {k_.x * r.x, k_.x * r.y + by, k_.x * r.z + bz},
        {k_.y * r.x - Number(2) * by, k_.y * r.y + bx, k_.y * r.z - f.A},
        {k_.z * r.x - Number(2) * bz, k_.z * r.y + f.A, k_.z * r.z + bx});
  }
  /// P'' at kappa'' = 0.
  Vec bias(const HelixFunctions<T>& f) const {
    const T a_v = f.A1 * k_v_, b_v = f.B1 * k_v_;  // A', B'
    const T a_vv = f.A2 * k_v_ * k_v_ + f.A1 * v_v_;
    const T b_vv = f.B2 * k_v_ * k_v_ + f.B1 * v_v_;
    return b_vv * z_ + Number(2) * b_v * z_v_ + f.B * z_vv() + a_vv * u_ +
           Number(2) * a_v * u_v_;
  }

  /// rho times the acceleration plus c times the velocity of its points, seen from a
  /// start that moves with v, omega, a, alpha.
  AlongHelix<T> inertial(const Number& rho, const Number& c, const Vec3<Number>& v,
                         const Vec3<Number>& omega, const Vec3<Number>& a,
                         const Vec3<Number>& alpha) const {
    // rho (a + alpha x P + omega x (omega x P + 2 P') + P'') + c (v + omega x P + P').
    const Vec3<Number> spin = rho * alpha + c * omega;
    const auto carried = [&](const auto& x) {
      return cross(spin, x) + cross(rho * omega, cross(omega, x));
    };
    const auto moved = [&](const Vec& x) {  // x: a constant of P'
      return cross(Number(2) * rho * omega, x) + c * x;
    };
    const T twice = Number(2) * rho * k_v_, square = rho * k_v_ * k_v_, own = rho * v_v_;
    AlongHelix<T> all;
    all.one = rho * a + c * v;
    all.s = carried(Vec3<Number>{Number(1), Number(0), Number(0)});
    all.A = carried(u_) + moved(u_v_);
    all.B = carried(z_) + moved(l_v_) + rho * z_vv();
    all.A1 = k_v_ * moved(u_) + own * u_ + twice * u_v_;
    all.B1 = k_v_ * moved(z_) + own * z_ + twice * z_v_;
    all.A2 = square * u_;
    all.B2 = square * z_;
    return all;
  }

  /// Adds the contribution of kappa'' to `all`: rho times P_kappa kappa''.
  void add_second(const Number& rho, const Vec& second, AlongHelix<T>& all) const {
    const T along = rho * dot(k_, second);
    all.A = all.A + rho * Vec{T(0), second.z, -second.y};
    all.B = all.B + rho * along_l(second);
    all.A1 = all.A1 + along * u_;
    all.B1 = all.B1 + along * z_;
  }

  struct Turn {
    Matrix rotation;  // E, from the components of the tip to those of the start
    Matrix turn;      // W: angular velocity of the tip = W kappa'
    Vec velocity;     // W kappa'
    Vec bias;         // its derivative at kappa'' = 0
  };
  Turn turn(const T& s, const HelixFunctions<T>& f, const T& x2) const {
    Turn t;
    t.rotation = of_cross(T(1), f.S, f.A, x2);
    t.turn = of_cross(s, f.A, f.B, x2);
    t.velocity = t.turn * v_;
    const Vec turned = cross(k_, v_);
    t.bias = k_v_ * (f.A1 * turned + f.B1 * cross(k_, turned)) + f.B * cross(v_, turned);
    return t;
  }

  /// sum_j x_j l_j, and the three numbers l_j . b + m_j . a.
  Vec along_l(const Vec& x) const {
    return {Number(-2) * (k_.y * x.y + k_.z * x.z), k_.y * x.x + k_.x * x.y,
            k_.z * x.x + k_.x * x.z};
  }
  Vec back(const Vec& b, const Vec& a) const {
    return {k_.y * b.y + k_.z * b.z, k_.x * b.y - Number(2) * k_.y * b.x - a.z,
            k_.x * b.z - Number(2) * k_.z * b.x + a.y};
  }

 private:
  Vec z_vv() const { return Number(2) * cross(v_, u_v_); }  // z''
  /// a I + b K + c K^2.
  Matrix of_cross(const T& a, const T& b, const T& c, const T& x2) const {
    const T &x = k_.x, &y = k_.y, &z = k_.z;
    const T xy = c * (x * y), xz = c * (x * z), yz = c * (y * z);
    return {{{a + c * (x * x - x2), xy - b * z, xz + b * y},
             {xy + b * z, a + c * (y * y - x2), yz - b * x},
             {xz - b * y, yz + b * x, a + c * (z * z - x2)}}};
  }

  Vec k_, v_, u_, z_;
  T k_v_, v_v_;    // kappa . kappa', kappa' . kappa'
  Vec u_v_, z_v_;  // u' = sum kappa'_j m_j, z'
  Vec l_v_;        // sum kappa'_j l_j
};

/// Sums over the points of an element, weights w: of w times products of the functions,
/// and of forces times functions.
template <class T>
struct HelixSums {
  T one{}, s{}, A{}, B{}, A1{}, B1{};
  T ss{}, sA{}, sB{}, sA1{}, sB1{};
  T AA{}, AB{}, BB{}, AA1{}, AB1{}, BA1{}, BB1{}, A1A1{}, A1B1{}, B1B1{};
  Vec3<T> force, force_s, force_A, force_B, force_A1, force_B1;

  void add(const T& w, const T& arc, const HelixFunctions<T>& f) {
    const T with_s = w * arc, with_a = w * f.A, with_b = w * f.B, with_a1 = w * f.A1,
            with_b1 = w * f.B1;
    one += w;
    s += with_s;
    A += with_a;
    B += with_b;
    A1 += with_a1;
    B1 += with_b1;
    ss += with_s * arc;
    sA += with_s * f.A;
    sB += with_s * f.B;
    sA1 += with_s * f.A1;
    sB1 += with_s * f.B1;
    AA += with_a * f.A;
    AB += with_a * f.B;
    BB += with_b * f.B;
    AA1 += with_a * f.A1;
    AB1 += with_a * f.B1;
    BA1 += with_b * f.A1;
    BB1 += with_b * f.B1;
    A1A1 += with_a1 * f.A1;
    A1B1 += with_a1 * f.B1;
    B1B1 += with_b1 * f.B1;
  }
  void add_force(const Vec3<T>& f_w, const T& arc, const HelixFunctions<T>& f) {
    force = force + f_w;
    force_s = force_s + arc * f_w;
    force_A = force_A + f.A * f_w;
    force_B = force_B + f.B * f_w;
    force_A1 = force_A1 + f.A1 * f_w;
    force_B1 = force_B1 + f.B1 * f_w;
  }
};

/// Sums of forces times functions.
template <class T>
struct HelixForces {
  Vec3<T> s, A, B, A1, B1;
};
/// Moment of the forces about the start, sum P x f, and their work on the unknowns, sum
/// d_j . f with d_j = dP/dkappa_j.
template <class T>
struct HelixWork {
  Vec3<T> moment, unknown;

  HelixWork(const HelixElement<T>& element, const HelixForces<T>& f) {
    using Number = typename HelixElement<T>::Number;
    const Vec3<Number> e0{Number(1), Number(0), Number(0)};
    const Vec3<T>&u = element.u(), &z = element.z();
    moment = cross(e0, f.s) + cross(u, f.A) + cross(z, f.B);
    const T f_r = dot(u, f.A1) + dot(z, f.B1);
    unknown = f_r * element.k() + element.back(f.B, f.A);
  }
};

/// Sums over an element that the equations need, with d_j = dP/dkappa_j. For moments of
/// inertia w = weight.
template <class T>
struct HelixMoments {
  Vec3<T> first;            // sum w P
  Symmetric3<T> second;     // sum w P P^T
  Matrix3<T> momentum;      // rows j: sum w d_j
  Matrix3<T> spin;          // rows j: sum w P x d_j
  Symmetric3<T> inner;      // sum w d_i . d_j
  Vec3<T> moment, unknown;  // sum P x f, sum d_j . f

  HelixMoments(const HelixElement<T>& element, const Vec3<T>& k, const HelixSums<T>& m) {
    using Vec = Vec3<T>;
    const Vec &u = element.u(), &z = element.z();
    const Vec e0{T(1), T(0), T(0)};
    const auto combined = [&](const T& s, const T& a, const T& b) {  // s e0 + a u + b z
      return Vec{s + b * z.x, a * u.y + b * z.y, a * u.z + b * z.z};
    };
    const auto spread = [&](const T& a, const T& b) {  // a u + b z
      return Vec{b * z.x, a * u.y + b * z.y, a * u.z + b * z.z};
    };
    first = combined(m.s, m.A, m.B);
    const Vec s_p = combined(m.ss, m.sA, m.sB), a_p = combined(m.sA, m.AA, m.AB),
              b_p = combined(m.sB, m.AB, m.BB);  // sums of w times s P, A P, B P
    // P P^T = e0 (s P)^T + u (A P)^T + z (B P)^T.
    second = {s_p.x + z.x * b_p.x, u.y * a_p.y + z.y * b_p.y, u.z * a_p.z + z.z * b_p.z,
              s_p.y + z.x * b_p.y, s_p.z + z.x * b_p.z,       u.y * a_p.z + z.y * b_p.z};
    const Vec r = spread(m.A1, m.B1);
    const Vec a_r = spread(m.AA1, m.AB1), b_r = spread(m.BA1, m.BB1);
    const Vec u_z = cross(u, z);
    // P x r.
    const Vec p_r = cross(e0, spread(m.sA1, m.sB1)) + (m.AB1 - m.BA1) * u_z;
    const T r_r = m.A1A1 * dot(u, u) + m.B1B1 * dot(z, z);  // u . z = 0
    const Vec l[3] = {
        {T(0), k.y, k.z}, {T(-2) * k.y, k.x, T(0)}, {T(-2) * k.z, T(0), k.x}};
    momentum = {{k.x * r + m.B * l[0], k.y * r + m.B * l[1], k.z * r + m.B * l[2]}};
    momentum.row[1].z -= m.A;
    momentum.row[2].y += m.A;
    spin = {{k.x * p_r + cross(b_p, l[0]), k.y * p_r + cross(b_p, l[1]),
             k.z * p_r + cross(b_p, l[2])}};
    // a_p x m_1 = a_p x -e2, a_p x m_2 = a_p x e1.
    spin.row[1] = spin.row[1] + Vec{-a_p.y, a_p.x, T(0)};
    spin.row[2] = spin.row[2] + Vec{-a_p.z, T(0), a_p.x};
    const Vec g = element.back(b_r, a_r);
    const T xx = k.x * k.x, yy = k.y * k.y, zz = k.z * k.z, xy = k.x * k.y,
            xz = k.x * k.z, yz = k.y * k.z;
    inner = {xx * r_r + T(2) * k.x * g.x + m.BB * (yy + zz),
             yy * r_r + T(2) * k.y * g.y + m.BB * (T(4) * yy + xx) + m.AA,
             zz * r_r + T(2) * k.z * g.z + m.BB * (T(4) * zz + xx) + m.AA,
             xy * (r_r + m.BB) + k.x * g.y + k.y * g.x - m.AB * k.z,
             xz * (r_r + m.BB) + k.x * g.z + k.z * g.x + m.AB * k.y,
             yz * (r_r + T(4) * m.BB) + k.y * g.z + k.z * g.y};
    const HelixWork<T> work(element,
                            {m.force_s, m.force_A, m.force_B, m.force_A1, m.force_B1});
    moment = work.moment;
    unknown = work.unknown;
  }
};

}  // namespace tress::models
