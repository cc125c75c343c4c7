#pragma once

#include "math/lanes.h"

namespace tress::models {

/// Twist and curvatures (about e0, e1, e2) of a segment that vary linearly along it. They
/// go from mean - half at its start to mean + half at its tip. With x the arc length over
/// the segment's,
///
///     kappa(x) = mean + (2 x - 1) half.
///
/// The two functions are orthogonal, of squares 1 and 1/3. An element of constant strain
/// takes the mean.
template <class T>
struct LinearStrainOf {
  Vec3<T> mean, half;  // mean, and half the difference between tip and start

  /// Returns the mean, which elements of constant strain take.
  explicit operator Vec3<T>() const { return mean; }

  friend LinearStrainOf operator+(const LinearStrainOf& a, const LinearStrainOf& b) {
    return {a.mean + b.mean, a.half + b.half};
  }
  friend LinearStrainOf operator-(const LinearStrainOf& a, const LinearStrainOf& b) {
    return {a.mean - b.mean, a.half - b.half};
  }
  friend LinearStrainOf operator*(const T& s, const LinearStrainOf& a) {
    return {s * a.mean, s * a.half};
  }
  /// Returns the dot product over all entries.
  friend T dot(const LinearStrainOf& a, const LinearStrainOf& b) {
    return dot(a.mean, b.mean) + dot(a.half, b.half);
  }
};
/// Linear strain in double precision.
using LinearStrain = LinearStrainOf<double>;

/// Returns sum k_i x_i^2.
template <class T>
T weighed_square(const Vec3<T>& k, const Vec3<T>& x) {
  return k.x * x.x * x.x + k.y * x.y * x.y + k.z * x.z * x.z;
}
/// Returns sum k_i x_i^2 over mean and half.
template <class T>
T weighed_square(const LinearStrainOf<T>& k, const LinearStrainOf<T>& x) {
  return weighed_square(k.mean, x.mean) + weighed_square(k.half, x.half);
}

}  // namespace tress::models
