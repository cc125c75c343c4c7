#pragma once

#include <vector>

#include "experiments/validation/rods/motion.h"

/// Times, rates and frequencies of an observed motion.
namespace tress::experiments::validation {

/// Zero crossings, by linear interpolation over the step: error (omega h)^2/24 of a step
/// for an oscillation of rate omega.
std::vector<double> zeros(const Track& track);

/// Mean time between every second zero, from the first to the last even one (s). Throws
/// std::runtime_error when there are fewer than three.
double period(const Track& track);

/// Time (s) of the largest value, at the vertex of the parabola through the largest
/// sample and its neighbours. Steps must be equal.
double time_of_peak(const Track& track);

/// Returns the angular frequency in [from, to] (rad/s) that maximises the Fourier
/// integral of the value minus its mean under a Hann window. Other frequencies of the
/// signal disturb it little once they are 4 pi/duration away.
double strongest_rate(const Track& track, double from, double to);

/// Decay rate (1/s) of an oscillation about 0: the slope of ln(half swing) over time by
/// least squares. Throws std::runtime_error when there are fewer than three swings.
double decay_rate(const Track& track);

}  // namespace tress::experiments::validation
