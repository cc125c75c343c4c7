#pragma once

#include <functional>
#include <vector>

#include "models/math/frame.h"

namespace tress {

/// A twice differentiable function of time at one instant.
struct SignalValue {
  double value = 0, rate = 0, acceleration = 0;
};
using Signal = std::function<SignalValue(double t)>;

/// amplitude sin(2 pi frequency t)
Signal sine(double amplitude, double frequency);
/// amplitude (1 - cos(2 pi frequency t)): starts from rest
Signal one_minus_cosine(double amplitude, double frequency);
/// From 0 to `height` between t0 and t0 + duration, C^2 (6 x^5 - 15 x^4 + 10 x^3).
Signal smooth_step(double height, double t0, double duration);
/// Travels at `speed` and comes to rest between t0 and t0 + duration, C^2.
Signal stop(double speed, double t0, double duration);
Signal sum(Signal a, Signal b);

/// Where the clamp is and how it moves: position in the world (m), frame (its e0 is the
/// root tangent), and their first and second derivatives (angular ones in world
/// components).
struct RootPose {
  Vec x, v, a;
  Frame frame;
  Vec omega, alpha;
};

/// Prescribed rigid motion of a clamp: translations along fixed directions and rotations
/// about fixed world axes through the root, each driven by a signal. Rotations apply in
/// the order given (the first one first).
struct RootMotion {
  struct Part {
    Vec direction;  // need not have length 1 for translations; axes are normalised
    Signal signal;
  };
  Vec position;  // at rest
  Frame frame;   // at rest
  std::vector<Part> translations;
  std::vector<Part> rotations;

  bool fixed() const { return translations.empty() && rotations.empty(); }
  RootPose at(double t) const;  // never allocates
};

}  // namespace tress
