#pragma once

#include <algorithm>
#include <concepts>
#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "contract/layers.h"
#include "math/frame.h"
#include "models/motion/by_time.h"

namespace tress::models {

/// Values at one instant of a twice differentiable function of time.
struct SignalValue {
  /// The function and its derivatives by time.
  double value = 0, rate = 0, acceleration = 0;
};
/// The times at which it is only C^2, a third derivative jumps, are its breakpoints. It
/// may jump at teleports, which divide it into pieces.
class Signal {
 public:
  Signal() = default;
  /// Takes a function without jumps; `breakpoints` in s.
  template <class F>
  requires std::convertible_to<F, std::function<SignalValue(double)>> &&
      (!std::same_as<std::remove_cvref_t<F>, Signal>)
          Signal(F value, std::vector<double> breakpoints = {})
      : Signal([value = std::move(value)](double t, double) { return value(t); },
               std::move(breakpoints)) {}
  /// Takes a function of t and of a time in the piece to be evaluated.
  template <class F>
  requires std::convertible_to<F, std::function<SignalValue(double, double)>> Signal(
      F value, std::vector<double> breakpoints)
      : value_(std::move(value)), breakpoints_(std::move(breakpoints)) {
    std::ranges::sort(breakpoints_);
  }

  /// Returns false for the constant 0.
  explicit operator bool() const { return static_cast<bool>(value_); }
  /// Evaluates the function at t (s).
  SignalValue operator()(double t) const { return value_(t, t); }
  /// Evaluates at t the piece that contains `since` (s), whose ends continue straight.
  SignalValue operator()(double t, double since) const { return value_(t, since); }
  const std::vector<double>& breakpoints() const { return breakpoints_; }  // ascending

 private:
  std::function<SignalValue(double, double)> value_;
  std::vector<double> breakpoints_;
};

/// amplitude sin(2 pi frequency t)
Signal sine(double amplitude, double frequency);
/// amplitude (1 - cos(2 pi frequency t)): starts from rest
Signal one_minus_cosine(double amplitude, double frequency);
/// Returns a step from 0 to `height` between t0 and t0 + duration (s, > 0, else
/// InputError), C^2: height (6 x^5 - 15 x^4 + 10 x^3).
Signal smooth_step(double height, double t0, double duration);
/// Returns a motion at `speed` that passes 0 at t0 and stops at t0 + duration (s, > 0,
/// else InputError), after a further speed duration/2. C^2: rate speed (1 - 3 x^2 + 2
/// x^3).
Signal stop(double speed, double t0, double duration);
/// Returns the sum of two signals.
Signal sum(Signal a, Signal b);
/// Returns a motion to `height` and back, each in `duration`, from t = 0 on: two
/// smooth_steps.
Signal there_and_back(double height, double duration);

/// A cross-section of a strand in space: centre (m) and material frame, e0 the tangent.
struct StrandPlace {
  Vec x;        // centre of the section
  Frame frame;  // material frame
};

/// Position and motion of the clamp: position in the world (m), frame (e0 is the root
/// tangent), and their first and second derivatives (angular ones in world components).
struct RootPose {
  Vec x, v, a;       // position, velocity, acceleration
  Frame frame;       // material frame
  Vec omega, alpha;  // angular velocity and acceleration
};

/// Prescribed rigid motion of a clamp: rotations about fixed world axes through one
/// centre, then translations along fixed directions, each driven by a signal. With R_i
/// the rotation of part i about axis a_i by the angle s_i(t), applied in order i = 1..n,
///
///     R = R_n ... R_1,   frame = R frame_0,   x = c + R (x_0 - c) + sum_j d_j s_j
///     omega <- R_i omega + s_i' a_i            (from omega = alpha = 0, i = 1..n)
///     alpha <- R_i alpha + s_i'' a_i + s_i' a_i x (R_i omega)
///
/// exact up to rounding; O(parts).
struct RootMotion {
  /// One translation or rotation.
  struct Part {
    Vec direction;  // translation: any length; rotation axis: not 0, normalised
    Signal signal;  // distance (m) or angle (rad) over time
  };
  Vec position;               // at rest, m
  Frame frame;                // at rest
  std::optional<Vec> centre;  // all axes pass through it, m; unless given, `position`
  std::vector<Part> translations;  // translations, after the rotations
  std::vector<Part> rotations;     // rotations, the first one first
  /// Times at which the pose jumps (s, ascending), of teleport_time().
  std::vector<double> teleports;
  /// Last teleport that was carried out (s), or by_time.
  double since = by_time;

  /// Returns true if nothing moves.
  bool fixed() const { return translations.empty() && rotations.empty(); }
  /// Returns the pose at time t (s); never allocates. Beyond teleports that were not
  /// carried out the motion goes on straight.
  RootPose at(double t) const { return at(t, since); }
  /// Returns the pose at time t (s) as after the teleport at `last`.
  RootPose at(double t, double last) const;
  /// The first of its signals' breakpoints after t, or infinity.
  double next_breakpoint(double t) const;
  /// Returns the first teleport after t, or infinity.
  double next_teleport(double t) const;
};

/// Returns the motion of a place that this motion carries rigidly: it is at `place` at
/// t = 0.
RootMotion carried(RootMotion by, const StrandPlace& place);

/// Throws InputError naming `where` unless the frame is a rotation, axes are not 0, every
/// part has a signal and all numbers are finite.
void check(const RootMotion& motion, const std::string& where);

}  // namespace tress::models
