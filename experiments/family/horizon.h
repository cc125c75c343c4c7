#pragma once

#include <vector>

#include "contract/integrator.h"
#include "contract/system.h"
#include "simulation/run/simulation.h"

namespace tress::experiments::family {

/// One of two computations of a strand's tip, a method with its options.
struct Side {
  System& system;
  std::string_view integrator;
  Options options;
};

/// The tips of two independent computations, at t_end k / samples, k = 1, 2, ..., up to
/// the horizon. A strand without friction is chaotic once it whips: any error, that of
/// rounding too, grows as exp(t), and beyond the time at which two converged methods part
/// there is no solution to compare with, only invariants.
struct Horizon {
  std::vector<double> tip, other;  // (3 samples) m
  /// The two are further apart at the next sample; else one of them ended there.
  bool parted = false;

  int samples() const { return static_cast<int>(tip.size() / 3); }
};

/// Both side by side until their tips are `apart` (root mean square from the start, over
/// `length`), one of them ends, or t_end comes.
Horizon horizon(const Side& one, const Side& other, double t_end, int samples,
                double length, double apart);

/// How much a deviation of the strand's first velocities grows: the root mean square
/// distance of the tip from `tip` over `length`, at as many samples as that has, over the
/// deviation, of size `apart` (integrators' PointNorm: the largest |dx|/L or |du|
/// sqrt(L/g)/L of a point). `side` computes as `tip` was computed; where it ends before,
/// to there. One deviation is tried, of all velocities at random: a lower bound of the
/// most that any grows by.
double growth(const Side& side, In tip, double t_end, int samples, double length,
              double apart);

/// Growth of the deviation of a body that nothing holds back or drives apart: positions
/// move on with the speed, whose unit is `length` in the time of a fall over it.
double free_growth(double t_end, double length);

}  // namespace tress::experiments::family
