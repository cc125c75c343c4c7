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
 public:
  using Real = R;
  using Vec = Vec3<R>;
  using Frame = FrameOf<R>;
  using Strain = Vec;
  static constexpr int functions = 1;

  /// The functions at one arc length, or at a pack of them.
  template <class T>
  struct At {
    T s;
    HelixFunctions<T> f;
  };

  // d^m P/dk^m times `factor`, m = 0 to 3.
  struct Zeroth {
    R k;
    template <class T>
    Vec3<T> at(const At<T>& p) const {
      return {p.f.S, T(0), T(-k) * p.f.A};
    }
  };
  struct First {
    R k, factor;
    template <class T>
    Vec3<T> at(const At<T>& p) const {
      const auto [x, z] = slope(p, k);
      return {T(factor) * x, T(0), T(factor) * z};
    }
  };
  struct Second {
    R k, factor;
    template <class T>
    Vec3<T> at(const At<T>& p) const {
      const auto [x, z] = curvature(p, k);
      return {T(factor) * x, T(0), T(factor) * z};
    }
  };
  struct Third {
    R k, factor;
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
    R k, rate, second;
    template <class T>
    Vec3<T> at(const At<T>& p) const {
      const auto [x1, z1] = slope(p, k);
      const auto [x2, z2] = curvature(p, k);
      const T square(rate * rate);
      return {T(second) * x1 + square * x2, T(0), T(second) * z1 + square * z2};
    }
  };
  struct AccelerationSlope {
    Second second;
    Third third;
    template <class T>
    Vec3<T> at(const At<T>& p) const {
      return second.at(p) + third.at(p);
    }
  };
  /// Rotations about e1.
  struct Turn {
    R factor;
    template <class T>
    Vec3<T> at(const At<T>& p) const {
      return {T(0), T(factor) * p.s, T(0)};
    }
  };
  /// W does not depend on k.
  struct Nothing {
    Vec at(const At<R>&) const { return {}; }
  };

  ArcOf() = default;
  ArcOf(const Vec& kappa, const R& length) : k_(kappa.y), length_(length) {}

  template <class T>
  At<T> point(const T& s) const {
    return {s, helix_functions(s, k_ * k_, length_)};
  }
  At<R> tip() const { return point(length_); }

  Turn W(const Vec& y) const { return {y.y}; }
  Nothing dW(const Vec&, const Vec&) const { return {}; }
  Nothing d2W(const Vec&, const Vec&, const Vec&) const { return {}; }

  Zeroth position() const { return {k_}; }
  First first(const Vec& x) const { return {k_, x.y}; }
  Second second(const Vec& x1, const Vec& x2) const { return {k_, x1.y * x2.y}; }
  Third third(const Vec& x1, const Vec& x2, const Vec& x3) const {
    return {k_, x1.y * x2.y * x3.y};
  }
  Acceleration acceleration(const Vec& rate, const Vec& second) const {
    return {k_, rate.y, second.y};
  }
  /// Returns the derivative of acceleration() along x.
  AccelerationSlope acceleration_slope(const Vec& rate, const Vec& second,
                                       const Vec& x) const {
    return {this->second(second, x), third(rate, rate, x)};
  }

  /// E(s) y: sin ks = k S, cos ks = 1 - k^2 A.
  template <class T>
  Vec3<T> rotated(const At<T>& p, const Vec& y) const {
    const T sine = T(k_) * p.f.S, cosine = T(1) - T(k_ * k_) * p.f.A;
    return {cosine * T(y.x) + sine * T(y.z), T(y.y), cosine * T(y.z) - sine * T(y.x)};
  }
  Frame rotation(const At<R>& p) const {
    const R sine = k_ * p.f.S, cosine = 1 - k_ * k_ * p.f.A;
    return {{cosine, R(0), -sine}, {R(0), R(1), R(0)}, {sine, R(0), cosine}};
  }
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

using Arc = ArcOf<double>;

}  // namespace tress::models
