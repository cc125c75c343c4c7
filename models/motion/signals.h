#pragma once

#include <span>
#include <vector>

#include "models/motion/root_motion.h"

namespace tress::models {

/// A body with one degree of freedom x, at rest until a force acts from t0 on:
/// inertia x'' + damping x' + stiffness x = force sin(2 pi frequency (t - t0)).
struct Oscillator {
  double inertia = 1;    // kg m^2 of an angle x, > 0
  double damping = 0;    // N m s, >= 0
  double stiffness = 0;  // N m, >= 0
  double force = 0;      // N m
  double frequency = 1;  // Hz, > 0
};
/// The exact x(t), C^2. With w^2 = stiffness/inertia, d = damping/(2 inertia), W = 2 pi
/// frequency, f = force/inertia and D = (w^2 - W^2)^2 + (2 d W)^2:
///
///     x = P sin W t + Q cos W t - exp(-d t) (Q C(t) + (P W + d Q) S(t))
///     P = f (w^2 - W^2)/D, Q = -2 f d W/D, C and S = cos and sin over the rate
///     sqrt(w^2 - d^2), cosh and sinh where that is imaginary.
///
/// Error: about eps times the largest term; these exceed x near an undamped resonance.
/// Throws InputError on numbers out of range and on that resonance itself, which grows
/// without bound.
Signal driven_oscillator(const Oscillator& body, double t0);

/// Returns a signal through `values` at `times` (s, ascending, at least two), C^2
/// everywhere: at rest until the first time and after the last. A cubic spline. Its first
/// and last interval are halved by an additional knot (a single interval is divided in
/// three), to satisfy the rest conditions x' = x'' = 0 at either end. Two equal times are
/// a teleport: the signal jumps from the first value to the second. The splines before
/// and after it have x'' = 0 there and continue straight. Throws InputError on other
/// times.
Signal keyframes(const std::vector<double>& times, const std::vector<double>& values);

/// Returns a signal that takes `values` at `times` (s, ascending, at least one) and rests
/// there. Between two times it is the quintic of smooth_step(), C^2 everywhere. Throws
/// InputError on other times.
Signal rests(const std::vector<double>& times, const std::vector<double>& values);

/// Returns a rigid motion by rows of t, x, y, z and an angle about each axis (s, m, rad):
/// each column is a signal of keyframes(). The axes (any length) pass through `centre`,
/// where the body is at rest; the first one turns it first. Two rows with the same time
/// are a teleport. Throws InputError on rows out of order.
RootMotion keyframe_motion(std::span<const double> rows, std::span<const Vec> axes,
                           const Vec& centre);
/// Axes of rows of t, x, y, z and the angles about x, y and z.
inline constexpr Vec world_axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

}  // namespace tress::models
