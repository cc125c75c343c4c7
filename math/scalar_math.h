#pragma once

#include <cmath>

#include "math/lane_math.h"

/// The functions of math/lane_math.h for one number, so that kernels over packs also take
/// `double`. Include it before the kernel: templates do not find later overloads for a
/// fundamental type.
namespace tress {

/// Returns 1/sqrt(x).
inline double inverse_sqrt(double x) { return 1 / std::sqrt(x); }

/// Returns the sine and cosine of x (rad), bit for bit as kernels over packs do for |x|
/// <= 1e4.
inline SineCosine<double> sine_cosine(double x) {
  if (!(std::abs(x) <= 1e4)) return {std::sin(x), std::cos(x)};
  const auto both = sine_cosine(PackOf<double, 1>(x));
  return {both.sine[0], both.cosine[0]};
}

/// Returns the angle of (x, y) from the x axis (rad), bit for bit as kernels over packs
/// do.
inline double arc_tangent(double y, double x) {
  return arc_tangent(PackOf<double, 1>(y), PackOf<double, 1>(x))[0];
}

}  // namespace tress
