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

/// Tips of two independent computations, at t_end k / samples, k = 1, 2, ..., up to the
/// horizon. A strand without friction is chaotic once its motion is fast: any error, that
/// of rounding too, grows as exp(t). Beyond the time at which two converged methods part
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

/// Returns the growth of a deviation to that of the tip, a lower bound. It is the largest
/// ratio of the tip's deviation from an instant s on to that of the strand at s. Instants
/// s are t = 0 and the first `until` samples. The tip's is the root mean square over all
/// later samples, over `length`. The strand's is PointNorm: the largest |dx|/L or |du|
/// sqrt(L/g)/L of a point. The deviations are a few random ones of the first velocities,
/// of size `apart`. Several are needed because the fastest growing one comes to dominate
/// only with time [Benettin et al. 1980, Meccanica 15, 9]. 0: a run ends before.
double growth(const Side& side, double t_end, int samples, int until, double apart);

/// Returns the growth of the deviation of a body without forces: positions grow with the
/// speed, whose unit is `length` in the time of a fall over it.
double free_growth(double t_end, double length);

}  // namespace tress::experiments::family
