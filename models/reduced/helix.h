#pragma once

#include "contract/layers.h"
#include "math/frame.h"
#include "math/helix.h"

namespace tress::models {

/// Kinematics of an element of constant Darboux vector kappa (twist, curvatures; in the
/// material frame, e0 the tangent), seen from the frame at its start [Bertails et al.
/// 2006]. With K = [kappa]x and the functions of math/helix.h at arc length s:
///
///     E(s) = exp(sK) = I + S K + A K^2           frame at s
///     W(s) = int_0^s E = s I + A K + B K^2       angular velocity = W kappa'
///     P(s) = W(s) e0                             position
///
/// Derivatives with respect to kappa are directional and multilinear: dW[x] y is the
/// derivative of W y along x, d2W[x1, x2] y the second one. Derivatives of P follow with
/// y = e0. Each is a sum of a few constant vectors weighted by the functions, prepared
/// once per element and evaluated at any s (a number or a pack). Straight elements need
/// no special case.
template <class T>
class HelixOf {
  using Vec = Vec3<T>;
  using Frame = FrameOf<T>;

 public:
  using Real = T;      // scalar: a number, or a pack of SIMD lanes
  using Strain = Vec;  // twist and curvatures of an element
  /// Number of functions of arc length for each component of a strain.
  static constexpr int functions = 1;

  /// The functions at one arc length, or at a pack of them.
  template <class P>
  struct At {
    P s;                  // arc length
    HelixFunctions<P> f;  // functions at the arc length
  };

  /// W y along the element; P for y = e0.
  struct Zeroth {
    Vec s, A, B;  // constant vector of each function
    /// Returns the vector at place p.
    template <class P>
    Vec3<P> at(const At<P>& p) const {
      return weighted(p.s, s) + weighted(p.f.A, A) + weighted(p.f.B, B);
    }
  };
  /// First derivative of W y by kappa, along one direction.
  struct First {
    Vec A, A1, B, B1;  // constant vector of each function
    /// Returns the vector at place p.
    template <class P>
    Vec3<P> at(const At<P>& p) const {
      return weighted(p.f.A, A) + weighted(p.f.A1, A1) + weighted(p.f.B, B) +
             weighted(p.f.B1, B1);
    }
  };
  /// Second derivative of W y by kappa, along two directions.
  struct Second {
    Vec A1, A2, B, B1, B2;  // constant vector of each function
    /// Returns the vector at place p.
    template <class P>
    Vec3<P> at(const At<P>& p) const {
      return weighted(p.f.A1, A1) + weighted(p.f.A2, A2) + weighted(p.f.B, B) +
             weighted(p.f.B1, B1) + weighted(p.f.B2, B2);
    }
  };
  /// Third derivative of W y by kappa, along three directions.
  struct Third {
    Vec A1, A2, A3, B1, B2, B3;  // constant vector of each function
    /// Returns the vector at place p.
    template <class P>
    Vec3<P> at(const At<P>& p) const {
      return weighted(p.f.A1, A1) + weighted(p.f.A2, A2) + weighted(p.f.A3, A3) +
             weighted(p.f.B1, B1) + weighted(p.f.B2, B2) + weighted(p.f.B3, B3);
    }
  };

  /// P'', the second derivative of P by time, along the element.
  struct Acceleration {
    Vec A, A1, A2, B, B1, B2;  // constant vector of each function
    /// Returns the vector at place p.
    template <class P>
    Vec3<P> at(const At<P>& p) const {
      return weighted(p.f.A, A) + weighted(p.f.A1, A1) + weighted(p.f.A2, A2) +
             weighted(p.f.B, B) + weighted(p.f.B1, B1) + weighted(p.f.B2, B2);
    }
  };

  /// The derivative of Acceleration with respect to kappa.
  struct AccelerationSlope {
    Vec A1, A2, A3, B, B1, B2, B3;  // constant vector of each function
    /// Returns the vector at place p.
    template <class P>
    Vec3<P> at(const At<P>& p) const {
      return weighted(p.f.A1, A1) + weighted(p.f.A2, A2) + weighted(p.f.A3, A3) +
             weighted(p.f.B, B) + weighted(p.f.B1, B1) + weighted(p.f.B2, B2) +
             weighted(p.f.B3, B3);
    }
  };

  HelixOf() = default;
  /// Takes the Darboux vector and the length, which no place may exceed.
  HelixOf(const Vec& kappa, const T& length)
      : kappa_(kappa), length_(length), x2_(dot(kappa, kappa)), along_(kappa, tangent) {}

  /// Returns the place at arc length s, a number or a pack.
  template <class P>
  At<P> point(const P& s) const {
    return {s, helix_functions(s, x2_, length_)};
  }
  /// Returns the place of the tip.
  At<T> tip() const { return point(length_); }

  /// Returns W y along the element.
  Zeroth W(const Vec& y) const {
    const Vec u = cross(kappa_, y);
    return {y, u, cross(kappa_, u)};
  }
  /// Returns the derivative of W y along x.
  First dW(const Vec& x, const Vec& y) const { return first_of(Terms(kappa_, y), x); }
  /// Returns the second derivative of W y along x1 and x2.
  Second d2W(const Vec& x1, const Vec& x2, const Vec& y) const {
    return second_of(Terms(kappa_, y), x1, x2);
  }

  // Positions of the element's points.
  /// Returns P along the element.
  Zeroth position() const { return W(tangent); }
  /// Returns the derivative of P along x.
  First first(const Vec& x) const { return first_of(along_, x); }
  /// Returns the second derivative of P along x1 and x2.
  Second second(const Vec& x1, const Vec& x2) const { return second_of(along_, x1, x2); }
  /// Returns the third derivative of P along x1, x2 and x3.
  Third third(const Vec& x1, const Vec& x2, const Vec& x3) const {
    return third_of(along_, x1, x2, x3);
  }
  /// Returns P'' for kappa' = rate and kappa'' = second.
  Acceleration acceleration(const Vec& rate, const Vec& second) const {
    const First f = first(second);
    const Second b = this->second(rate, rate);
    return {f.A, f.A1 + b.A1, b.A2, f.B + b.B, f.B1 + b.B1, b.B2};
  }
  /// Returns the derivative of acceleration() along x.
  AccelerationSlope acceleration_slope(const Vec& rate, const Vec& second,
                                       const Vec& x) const {
    const Second a = this->second(second, x);
    const Third b = third(rate, rate, x);
    return {a.A1 + b.A1, a.A2 + b.A2, b.A3, a.B, a.B1 + b.B1, a.B2 + b.B2, b.B3};
  }

  /// Returns E y at place p.
  template <class P>
  Vec3<P> rotated(const At<P>& p, const Vec& y) const {
    const Vec u = cross(kappa_, y);
    return weighted(P(1), y) + weighted(p.f.S, u) + weighted(p.f.A, cross(kappa_, u));
  }
  /// Returns the frame E at place p.
  Frame rotation(const At<T>& p) const {
    return {rotated(p, {1, 0, 0}), rotated(p, {0, 1, 0}), rotated(p, {0, 0, 1})};
  }
  /// Returns W^T y at place p: W with the opposite sign of kappa.
  Vec W_transposed(const At<T>& p, const Vec& y) const {
    const Vec u = cross(kappa_, y);
    return p.s * y - p.f.A * u + p.f.B * cross(kappa_, u);
  }
  /// Returns (dW[x])^T y at place p.
  Vec dW_transposed(const At<T>& p, const Vec& x, const Vec& y) const {
    const First d = dW(x, y);
    return p.f.B * d.B + p.f.B1 * d.B1 - p.f.A * d.A - p.f.A1 * d.A1;
  }

  static constexpr Vec3<double> tangent{1, 0, 0};  // e0

 private:
  template <class P>
  static Vec3<P> weighted(const P& weight, const Vec& x) {
    return {weight * P(x.x), weight * P(x.y), weight * P(x.z)};
  }

  /// u = K y, z = K^2 y and the derivatives of z along x, and along x1 and x2.
  struct Terms {
    Terms() = default;
    Terms(const Vec& k, const Vec& y0)
        : kappa(k), y(y0), u(cross(k, y0)), z(cross(k, u)) {}
    Vec z_of(const Vec& x) const { return cross(x, u) + cross(kappa, cross(x, y)); }
    Vec z_of(const Vec& x1, const Vec& x2) const {
      return cross(x1, cross(x2, y)) + cross(x2, cross(x1, y));
    }
    Vec kappa, y, u, z;
  };

  static First first_of(const Terms& t, const Vec& x) {
    const T k = dot(t.kappa, x);
    return {cross(x, t.y), k * t.u, t.z_of(x), k * t.z};
  }
  static Second second_of(const Terms& t, const Vec& x1, const Vec& x2) {
    const T k1 = dot(t.kappa, x1), k2 = dot(t.kappa, x2), c = dot(x1, x2);
    return {c * t.u + k1 * cross(x2, t.y) + k2 * cross(x1, t.y), (k1 * k2) * t.u,
            t.z_of(x1, x2), c * t.z + k1 * t.z_of(x2) + k2 * t.z_of(x1), (k1 * k2) * t.z};
  }
  static Third third_of(const Terms& t, const Vec& x1, const Vec& x2, const Vec& x3) {
    const T k1 = dot(t.kappa, x1), k2 = dot(t.kappa, x2), k3 = dot(t.kappa, x3);
    const T c12 = dot(x1, x2), c13 = dot(x1, x3), c23 = dot(x2, x3);
    const T mixed = c12 * k3 + c13 * k2 + c23 * k1;
    const Vec u1 = cross(x1, t.y), u2 = cross(x2, t.y), u3 = cross(x3, t.y);
    const Vec z1 = t.z_of(x1), z2 = t.z_of(x2), z3 = t.z_of(x3);
    return {c12 * u3 + c13 * u2 + c23 * u1,
            mixed * t.u + (k1 * k2) * u3 + (k1 * k3) * u2 + (k2 * k3) * u1,
            (k1 * k2 * k3) * t.u,
            c12 * z3 + c13 * z2 + c23 * z1 + k1 * t.z_of(x2, x3) + k2 * t.z_of(x1, x3) +
                k3 * t.z_of(x1, x2),
            mixed * t.z + (k1 * k2) * z3 + (k1 * k3) * z2 + (k2 * k3) * z1,
            (k1 * k2 * k3) * t.z};
  }

  Vec kappa_;
  T length_{};
  T x2_{};
  Terms along_;  // terms of positions: y = e0
};

/// Helix in double precision.
using Helix = HelixOf<double>;

}  // namespace tress::models
