#pragma once

#include <vector>

#include "experiments/validation/rods/motion.h"

/// Times, rates and frequencies in what was seen of a motion.
namespace tress::experiments::validation {

/// Where the value passes 0, on the chord of the step: off by (omega h)^2/24 of a step of
/// an oscillation of rate omega.
std::vector<double> zeros(const Track& track);

/// Mean time between zeros two apart, from the first to the last even one (s). Throws
/// std::runtime_error when there are fewer than three.
double period(const Track& track);

/// Where the value is largest, at the vertex of the parabola through the largest sample
/// and its neighbours (s). Steps are equal.
double time_of_peak(const Track& track);

/// Angular frequency in [from, to] (rad/s) at which the Fourier integral of the value
/// under a Hann window (its mean taken off) is largest: other frequencies of the signal
/// disturb it little once they are 4 pi/duration away.
double strongest_rate(const Track& track, double from, double to);

/// Rate (1/s) of the decay of an oscillation about 0: the slope of ln(half swing) over
/// time by least squares. Throws std::runtime_error when there are fewer than three
/// swings.
double decay_rate(const Track& track);

}  // namespace tress::experiments::validation
