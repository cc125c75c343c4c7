#pragma once

#include "contract/layers.h"
#include "math/frame.h"
#include "math/helix.h"

namespace tress::models {

/// A helix (helix.h) without twist that bends about e1 only: with kappa = (0, k, 0), a
/// circular arc in the plane of e0 and e2,
///
///     P(s) = (S, 0, -k A),    E(s) e0 = (cos ks, 0, -sin ks),    W(s) e1 = s e1.
///
/// Directions x and y have only an e1 component. Derivatives with respect to k follow
/// from d/dk of f(k^2) = k f1 and from S = s - k^2 B, without cancellation at k = 0.
/// R = double, or Pack: four elements.
template <class R>
class ArcOf {
  using Vec = Vec3<R>;
  using Frame = FrameOf<R>;

 public:
  using Real = R;      // scalar: a number, or a pack of SIMD lanes
  using Strain = Vec;  // twist and curvatures of an element
  /// Number of functions of arc length for each component of a strain.
  static constexpr int functions = 1;

  /// The functions at one arc length, or at a pack of them.
  template <class T>
  struct At {
    T s;                  // arc length
    HelixFunctions<T> f;  // functions at the arc length
  };

  /// P along the element.
  struct Zeroth {
    R k;  // curvature
    /// Returns the vector at place p.
    template <class T>
    Vec3<T> at(const At<T>& p) const {
      return {p.f.S, T(0), T(-k) * p.f.A};
    }
  };
  /// dP/dk times `factor`.
  struct First {
    R k, factor;  // curvature, and factor of the derivative
    /// Returns the vector at place p.
    template <class T>
    Vec3<T> at(const At<T>& p) const {
      const auto [x, z] = slope(p, k);
      return {T(factor) * x, T(0), T(factor) * z};
    }
  };
  /// d^2 P/dk^2 times `factor`.
  struct Second {
    R k, factor;  // curvature, and factor of the derivative
    /// Returns the vector at place p.
    template <class T>
    Vec3<T> at(const At<T>& p) const {
      const auto [x, z] = curvature(p, k);
      return {T(factor) * x, T(0), T(factor) * z};
    }
  };
  /// d^3 P/dk^3 times `factor`.
  struct Third {
    R k, factor;  // curvature, and factor of the derivative
    /// Returns the vector at place p.
    template <class T>
    Vec3<T> at(const At<T>& p) const {
      const T kk(k * k);
      const T x = T(-k) * (T(12) * p.f.B1 + kk * (T(9) * p.f.B2 + kk * p.f.B3));
      const T z = T(-3) * p.f.A1 - kk * (T(6) * p.f.A2 + kk * p.f.A3);
      return {T(factor) * x, T(0), T(factor) * z};
    }
  };
  /// P'' for k' = rate and k'' = second.
  struct Acceleration {
    R k, rate, second;  // k, k' and k''
    /// Returns the vector at place p.
    template <class T>
    Vec3<T> at(const At<T>& p) const {
      const auto [x1, z1] = slope(p, k);
      const auto [x2, z2] = curvature(p, k);
      const T square(rate * rate);
      return {T(second) * x1 + square * x2, T(0), T(second) * z1 + square * z2};
    }
  };
  /// Derivative of Acceleration by k.
  struct AccelerationSlope {
    Second second;  // term of k''
    Third third;    // term of k'^2
    /// Returns the vector at place p.
    template <class T>
    Vec3<T> at(const At<T>& p) const {
      return second.at(p) + third.at(p);
    }
  };
  /// W y along the element, a rotation about e1.
  struct Turn {
    R factor;  // component of y about e1
    /// Returns the vector at place p.
    template <class T>
    Vec3<T> at(const At<T>& p) const {
      return {T(0), T(factor) * p.s, T(0)};
    }
  };
  /// Derivatives of W, which does not depend on k.
  struct Nothing {
    /// Returns the zero vector.
    Vec at(const At<R>&) const { return {}; }
  };

  ArcOf() = default;
  /// Takes the Darboux vector, of which only the e1 component counts, and the length.
  ArcOf(const Vec& kappa, const R& length) : k_(kappa.y), length_(length) {}

  /// Returns the place at arc length s, a number or a pack.
  template <class T>
  At<T> point(const T& s) const {
    return {s, helix_functions(s, k_ * k_, length_)};
  }
  /// Returns the place of the tip.
  At<R> tip() const { return point(length_); }

  /// Returns W y along the element.
  Turn W(const Vec& y) const { return {y.y}; }
  /// Returns the derivative of W y: zero.
  Nothing dW(const Vec&, const Vec&) const { return {}; }
  /// Returns the second derivative of W y: zero.
  Nothing d2W(const Vec&, const Vec&, const Vec&) const { return {}; }

  /// Returns P along the element.
  Zeroth position() const { return {k_}; }
  /// Returns the derivative of P along x.
  First first(const Vec& x) const { return {k_, x.y}; }
  /// Returns the second derivative of P along x1 and x2.
  Second second(const Vec& x1, const Vec& x2) const { return {k_, x1.y * x2.y}; }
  /// Returns the third derivative of P along x1, x2 and x3.
  Third third(const Vec& x1, const Vec& x2, const Vec& x3) const {
    return {k_, x1.y * x2.y * x3.y};
  }
  /// Returns P'' for k' = rate and k'' = second.
  Acceleration acceleration(const Vec& rate, const Vec& second) const {
    return {k_, rate.y, second.y};
  }
  /// Returns the derivative of acceleration() along x.
  AccelerationSlope acceleration_slope(const Vec& rate, const Vec& second,
                                       const Vec& x) const {
    return {this->second(second, x), third(rate, rate, x)};
  }

  /// Returns E y at place p: sin ks = k S, cos ks = 1 - k^2 A.
  template <class T>
  Vec3<T> rotated(const At<T>& p, const Vec& y) const {
    const T sine = T(k_) * p.f.S, cosine = T(1) - T(k_ * k_) * p.f.A;
    return {cosine * T(y.x) + sine * T(y.z), T(y.y), cosine * T(y.z) - sine * T(y.x)};
  }
  /// Returns the frame E at place p.
  Frame rotation(const At<R>& p) const {
    const R sine = k_ * p.f.S, cosine = 1 - k_ * k_ * p.f.A;
    return {{cosine, R(0), -sine}, {R(0), R(1), R(0)}, {sine, R(0), cosine}};
  }
  /// Returns the product of the transposed dW[x] with y: zero.
  Vec dW_transposed(const At<R>&, const Vec&, const Vec&) const { return {}; }

 private:
  template <class T>
  struct InPlane {
    T x, z;
  };
  template <class T>
  static InPlane<T> slope(const At<T>& p, const R& k) {
    const T kk(k * k);
    return {T(-k) * (T(2) * p.f.B + kk * p.f.B1), -p.f.A - kk * p.f.A1};
  }
  template <class T>
  static InPlane<T> curvature(const At<T>& p, const R& k) {
    const T kk(k * k);
    return {T(-2) * p.f.B - kk * (T(5) * p.f.B1 + kk * p.f.B2),
            T(-k) * (T(3) * p.f.A1 + kk * p.f.A2)};
  }

  R k_{};
  R length_{};
};

/// Arc in double precision.
using Arc = ArcOf<double>;

}  // namespace tress::models
