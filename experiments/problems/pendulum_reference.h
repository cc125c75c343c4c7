#pragma once

#include "contract/layers.h"

namespace tress::experiments {

/// Exact motion of the plane pendulum theta'' = -omega^2 sin theta, theta from the
/// downward vertical, by Jacobi's elliptic functions. With m = sin^2(theta0/2) +
/// (theta0'/2 omega)^2:
///     m < 1 (swings):   sin(theta/2) = sqrt(m) sn(omega t + u0 | m)
///     m > 1 (rotates):  sin(theta/2) = sn(sqrt(m) omega t + u0 | 1/m)
/// Rounding-level accuracy away from m = 1. [Whittaker, Analytical Dynamics, art. 44]
class PendulumReference {
 public:
  struct State {
    double angle;  // rad, in (-pi, pi]
    double rate;   // rad/s
  };

  /// omega = sqrt(g / R) in rad/s.
  PendulumReference(double omega, State start);

  State at(double t) const;
  double period() const;  // s, of a swing or of one turn

 private:
  double omega_;
  double m_;
  double phase_;  // u0
  double sense_;  // of rotation, +-1
};

}  // namespace tress::experiments
