#pragma once

#include <cmath>
#include <limits>

#include "models/motion/root_motion.h"

namespace tress::models {

/// Rounding errors of a time, relative to it: frames and rows with the same time may
/// differ by fewer.
inline constexpr double time_rounding = 8 * std::numeric_limits<double>::epsilon();
/// Returns the time from which the pose is that after a teleport. It is just before the
/// time of the row: a frame at the row's time shows the pose after, however it was
/// rounded.
inline double teleport_time(double of_row) {
  return of_row - time_rounding * std::abs(of_row);
}
/// Returns a time before a teleport, at which runs end: rounded times of stages up to
/// there are before it, too.
inline double just_before(double teleport) {
  return teleport - time_rounding * std::abs(teleport);
}

/// Rigid displacement of a strand with its root at a teleport. In the frame of the root
/// nothing changes. In the world, with the turn R from the axes before to those after,
///
///     x -> X' + R (x - X),    v -> V' + Omega' x (x' - X') + R (v - V - Omega x (x - X))
///
/// for the root's position X, velocity V and angular velocity Omega.
struct Displacement {
  RootPose before, after;  // poses of the root
  Frame turn;              // R

  /// Returns the place after of a point that was at x, m.
  Vec place(const Vec& x) const { return after.x + turn * (x - before.x); }
  /// Returns the change of the root's angular velocity, in its axes after (rad/s).
  Vec spin() const { return after.omega - turn * before.omega; }
  /// Returns the velocity after of a point that was at x with the velocity v, m/s.
  Vec velocity(const Vec& x, const Vec& v) const {
    return after.v + turn * (v - before.v) + cross(spin(), turn * (x - before.x));
  }
};

/// Returns the displacement from one pose of a root to another.
inline Displacement displacement(const RootPose& before, const RootPose& after) {
  const auto turned = [&](const Vec& e) { return after.frame * before.frame.back(e); };
  return {before, after, {turned({1, 0, 0}), turned({0, 1, 0}), turned({0, 0, 1})}};
}
/// Returns the displacement by a motion at one of its teleports.
inline Displacement displacement(const RootMotion& motion, double teleport) {
  const double end = just_before(teleport);
  return displacement(motion.at(end, end), motion.at(teleport, teleport));
}

}  // namespace tress::models
