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
  /// Takes the Darboux vector and the largest arc length of at().
  LaneFunctions(const Vec3<T>& kappa, const T& length)
      : x2_(dot(kappa, kappa)),
        winding_(x2_ * length * length),
        short_(all_up_to(winding_, most)) {}

  /// Returns the functions at arc length s.
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
  /// Returns the square of |kappa|.
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

/// LaneFunctions of one strand, with the terms that its winding needs.
template <>
class LaneFunctions<double> {
 public:
  /// Takes the Darboux vector and the largest arc length of at().
  LaneFunctions(const Vec3<double>& kappa, double length)
      : x2_(dot(kappa, kappa)), length_(length) {}

  /// Computes the functions at one point, or at a pack of points.
  template <class S>
  HelixFunctions<S> at(const S& s) const {
    return helix_functions(s, x2_, length_);
  }
  /// Returns the square of |kappa|.
  double x2() const { return x2_; }

 private:
  double x2_, length_;
};

/// A vector along an element: constants weighted with the functions of arc length.
template <class T>
struct AlongHelix {
  Vec3<T> one, s, A, B, A1, B1, A2, B2;  // constants of 1, s and each function

  /// Returns the vector at arc length `arc`, where the functions are f.
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
  using Vec = Vec3<T>;
  using Matrix = Matrix3<T>;

 public:
  /// Type of constants, which have no derivatives of their own.
  using Number = typename ConstantOf<T>::Type;

  /// Takes kappa and kappa'.
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

  /// Returns the Darboux vector kappa.
  const Vec& k() const { return k_; }
  /// Returns the vector u = kappa x e0.
  const Vec& u() const { return u_; }
  /// Returns the vector z = kappa x u.
  const Vec& z() const { return z_; }

  /// Returns the position P at s.
  Vec position(const T& s, const HelixFunctions<T>& f) const {
    return {s + f.B * z_.x, f.A * u_.y + f.B * z_.y, f.A * u_.z + f.B * z_.z};
  }
  /// Returns the derivatives dP/dkappa_j as columns.
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

  /// Rotation of the tip and its rate.
  struct Turn {
    Matrix rotation;  // E, from the components of the tip to those of the start
    Matrix turn;      // W: angular velocity of the tip = W kappa'
    Vec velocity;     // W kappa'
    Vec bias;         // derivative of velocity at kappa'' = 0
  };
  /// Returns the rotation at s, with x2 = |kappa|^2.
  Turn turn(const T& s, const HelixFunctions<T>& f, const T& x2) const {
    Turn t;
    t.rotation = of_cross(T(1), f.S, f.A, x2);
    t.turn = of_cross(s, f.A, f.B, x2);
    t.velocity = t.turn * v_;
    const Vec turned = cross(k_, v_);
    t.bias = k_v_ * (f.A1 * turned + f.B1 * cross(k_, turned)) + f.B * cross(v_, turned);
    return t;
  }

  /// Returns the vector sum_j x_j l_j.
  Vec along_l(const Vec& x) const {
    return {Number(-2) * (k_.y * x.y + k_.z * x.z), k_.y * x.x + k_.x * x.y,
            k_.z * x.x + k_.x * x.z};
  }
  /// Returns the three numbers l_j . b + m_j . a.
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

}  // namespace tress::models
