#pragma once

/// Numbers of step control, of one strand (integrators/control/step_control.h) and of
/// strands in lanes (integrators/block/step_length.h).
namespace tress::integrators::step_factors {

inline constexpr double safety = 0.9;           // aim, as a factor on the ratio of steps
inline constexpr double least = 0.2, most = 5;  // bounds of the ratio of two steps
// After a step without a solution.
inline constexpr double unsolved = 0.25;         // ratio of the next step
inline constexpr double unsolved_ceiling = 0.5;  // ceiling over that step
inline constexpr double ceiling_growth = 1.05;   // ratio of ceilings of two steps

// First step over the time in which the body falls about its size, at tolerance 1: its
// estimate is far below any threshold for a motion that starts smoothly, and the control
// needs few trials otherwise.
/// First step over the time of a fall.
inline constexpr double first_part = 0.1;
// Steps below this part of that time are lost in rounding.
/// Shortest step over that time.
inline constexpr double shortest_part = 1e-11;

// In the norm of errors coordinates count this much: their error may be larger than that
// of points.
/// Weight of coordinates in the norm of errors.
inline constexpr double coordinate_weight = 1. / 15;

}  // namespace tress::integrators::step_factors
