#pragma once

#include "contract/layers.h"
#include "models/reduced/helix.h"

namespace tress::models {

/// Kinematics of a rigid straight link behind a ball joint with the rotation vector theta
/// and E = exp([theta]x). The link points along E e0 and turns with W(1) theta'. Rotation
/// and angular velocity of a joint are those of a Helix of length 1; positions are s E
/// e0. The rotation vector is regular for |theta| < 2 pi, which suffices for a joint
/// between links.
template <class R>
class BallLinkOf {
  using Vec = Vec3<R>;
  using Frame = FrameOf<R>;

 public:
  using Real = R;      // scalar: a number, or a pack of SIMD lanes
  using Strain = Vec;  // rotation vector of the joint
  /// Number of unknowns for each component of a strain.
  static constexpr int functions = 1;

  /// A place on the link.
  template <class T>
  struct At {
    T s;  // distance from the joint
  };
  /// Every vector of a rigid link is proportional to the distance from the joint.
  struct Ray {
    Vec direction;  // vector at the distance 1
    /// Returns the vector at place p.
    template <class T>
    Vec3<T> at(const At<T>& p) const {
      return {p.s * T(direction.x), p.s * T(direction.y), p.s * T(direction.z)};
    }
  };

  BallLinkOf() = default;
  /// Takes the rotation vector of the joint and the length of the link.
  BallLinkOf(const Vec& theta, const R& length)
      : joint_(theta, R(1)),
        at_(joint_.tip()),
        length_(length),
        along_(joint_.rotated(at_, Joint::tangent)) {}

  /// Returns the place at the distance s, a number or a pack.
  template <class T>
  At<T> point(const T& s) const {
    return {s};
  }
  /// Returns the place of the tip.
  At<R> tip() const { return {length_}; }

  /// W y or a derivative, the same everywhere on the link.
  struct Turn {
    Vec value;  // value at every place
    /// Returns the value, for any place.
    template <class T>
    Vec3<T> at(const At<T>&) const {
      return Vec3<T>(value);
    }
  };
  /// Returns W y along the link.
  Turn W(const Vec& y) const { return {joint_.W(y).at(at_)}; }
  /// Returns the derivative of W y along x.
  Turn dW(const Vec& x, const Vec& y) const { return {joint_.dW(x, y).at(at_)}; }
  /// Returns the second derivative of W y along x1 and x2.
  Turn d2W(const Vec& x1, const Vec& x2, const Vec& y) const {
    return {joint_.d2W(x1, x2, y).at(at_)};
  }

  // With t = E e0: dt[x] = (W x) x t, applied repeatedly.
  /// Returns P along the link.
  Ray position() const { return {along_}; }
  /// Returns the derivative of P along x.
  Ray first(const Vec& x) const { return {cross(w(x), along_)}; }
  /// Returns the second derivative of P along x1 and x2.
  Ray second(const Vec& x1, const Vec& x2) const {
    return {cross(dw(x2, x1), along_) + cross(w(x1), cross(w(x2), along_))};
  }
  /// Returns the third derivative of P along x1, x2 and x3.
  Ray third(const Vec& x1, const Vec& x2, const Vec& x3) const {
    const Vec t2 = cross(w(x2), along_), t3 = cross(w(x3), along_);
    const Vec t23 = cross(dw(x3, x2), along_) + cross(w(x2), t3);
    return {cross(d2W(x2, x3, x1).value, along_) + cross(dw(x2, x1), t3) +
            cross(dw(x3, x1), t2) + cross(w(x1), t23)};
  }
  /// Returns P'' for theta' = rate and theta'' = second.
  Ray acceleration(const Vec& rate, const Vec& second) const {
    const Vec turning = w(rate);
    return {cross(w(second) + dw(rate, rate), along_) +
            cross(turning, cross(turning, along_))};
  }
  /// Returns the derivative of acceleration() along x.
  Ray acceleration_slope(const Vec& rate, const Vec& second, const Vec& x) const {
    return {this->second(second, x).direction + third(rate, rate, x).direction};
  }

  /// Returns E y, for any place.
  template <class T>
  Vec3<T> rotated(const At<T>&, const Vec& y) const {
    return joint_.rotated(at_, y);
  }
  /// Returns the frame E, for any place.
  Frame rotation(const At<R>&) const { return joint_.rotation(at_); }
  /// Returns W^T y, for any place.
  Vec W_transposed(const At<R>&, const Vec& y) const {
    return joint_.W_transposed(at_, y);
  }
  /// Returns (dW[x])^T y, for any place.
  Vec dW_transposed(const At<R>&, const Vec& x, const Vec& y) const {
    return joint_.dW_transposed(at_, x, y);
  }

 private:
  using Joint = HelixOf<R>;

  Vec w(const Vec& x) const { return W(x).value; }
  Vec dw(const Vec& x, const Vec& y) const { return dW(x, y).value; }

  Joint joint_;
  typename Joint::template At<R> at_{};
  R length_{};
  Vec along_;
};

/// Link in double precision.
using BallLink = BallLinkOf<double>;

}  // namespace tress::models
