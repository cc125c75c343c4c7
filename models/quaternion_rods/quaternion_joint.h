#pragma once

#include "math/quaternion.h"
#include "models/strand/rod_joint.h"

namespace tress::models {

/// Bending and twisting between neighbouring quaternions x = (q_j, q_{j+1}) of a rod, or
/// between a clamp's frame and the first: strains 2 vec(conj(q_j) q_{j+1}) minus those at
/// rest.
/// A Part of strained.h.
template <class T>
struct QuaternionJointOf {
  /// Counts of strains, of coordinates in x, and of strains with friction.
  static constexpr int strains = 3, coordinates = 8, with_friction = 3;
  /// Rest values and coefficients of each strain.
  T rest[strains], stiffness[strains], friction[strains];

  QuaternionJointOf() = default;
  /// Takes the data of a joint.
  explicit QuaternionJointOf(const RodJoint& joint) {
    store3(joint.rest, rest);
    store3(joint.stiffness, stiffness);
    store3(joint.friction, friction);
  }
  /// Evaluates the strains at x.
  template <class U>
  void strain(const U* x, U* s) const {
    store3(turn_between(load_quaternion(x), load_quaternion(x + 4)), s);
    for (int k = 0; k < strains; ++k) s[k] = s[k] - U(rest[k]);
  }
  /// Evaluates the first derivatives of the strains by x.
  void gradient(const T* x, T (&g)[strains][coordinates]) const {
    T before[3][4], behind[3][4];
    turn_slope(T(-1) * load_quaternion(x + 4), before);
    turn_slope(load_quaternion(x), behind);
    for (int k = 0; k < 3; ++k) {
      for (int l = 0; l < 4; ++l) {
        g[k][l] = before[k][l];
        g[k][4 + l] = behind[k][l];
      }
    }
  }
  /// Strains are bilinear.
  void slope_of_speed(const T* /*x*/, const T* rate, T (&g)[strains][coordinates]) const {
    gradient(rate, g);
  }
  /// Adds second derivatives of stress . 2 vec(conj(p) q) = 2 p^T form q.
  void add_second(const T* /*x*/, const T* stress,
                  T (&h)[coordinates][coordinates]) const {
    const Vec3<T> s = T(2) * load3(stress);
    const T form[4][4] = {{T(0), s.x, s.y, s.z},
                          {-s.x, T(0), -s.z, s.y},
                          {-s.y, s.z, T(0), -s.x},
                          {-s.z, -s.y, s.x, T(0)}};
    for (int k = 0; k < 4; ++k) {
      for (int l = 0; l < 4; ++l) {
        h[k][4 + l] += form[k][l];
        h[4 + l][k] += form[k][l];
      }
    }
  }
};

/// Joint of one rod.
using QuaternionJoint = QuaternionJointOf<double>;

}  // namespace tress::models
