#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>

#include "models/head/head.h"

namespace tress::models {

/// A stage of a step of length h from (q_n, v_n) at t_n, of a diagonally implicit
/// Runge-Kutta method for q' = v, v' = a, without the velocities of its stages:
///
///     r(t_n + time h, q, v, a) = 0
///     v = v_bar + gamma h a,        v_bar = v_n + h (rate[0] a_0 + rate[1] a_1)
///     q = q_bar + (gamma h)^2 a,    q_bar = q_n + time h u,
///                                   u = v_n + h (drift[0] a_0 + drift[1] a_1)
///
/// a_0: the acceleration at t_n, a_1: that of the stage before.
struct LaneStage {
  double time = 1, gamma = 1;
  std::array<double, 2> rate{}, drift{};
};

/// What the last stage's state is off one of higher order from the same stages: h^2 times
/// the sum of drift[i] a_i in q, h times that of rate[i] a_i in v. It falls as h^falls,
/// and a step may have share tolerance^power of it in the norm of LaneError.
struct LaneEstimate {
  std::array<double, 3> rate, drift;
  double falls, share, power;

  double threshold(double tolerance) const { return share * std::pow(tolerance, power); }
};

/// A method by its stages. Where the first has gamma = 0 it is the last one of the step
/// before, and is solved in a strand's first step alone. The step ends with the last
/// stage's (q, v) if that is at its end, and else with
///
///     q_n + h v,    v_n + h a
struct LaneMethod {
  std::span<const LaneStage> stages;
  bool iterates;  // in every step; false: one correction solves a stage
  /// So many steps of a strand differ from those that follow: they solve the first stage
  /// that others have from the step before, or iterate where others do not.
  std::size_t first_steps = 0;
  /// So many last accelerations are kept of a strand, with two the lengths of both steps.
  std::size_t accelerations = 0;
  const LaneEstimate* estimate = nullptr;  // null: it has none

  /// The first stage that every step solves.
  std::size_t first() const { return stages[0].gamma == 0 ? 1 : 0; }
  /// Numbers of state of a strand of so many unknowns.
  std::size_t of_state(std::size_t unknowns) const {
    return (2 + accelerations) * unknowns + (accelerations == 2 ? 2 : 0);
  }
};

namespace lane_stages {

inline constexpr LaneStage backward_euler[] = {{}};
/// One correction from the line through the last two accelerations, as integrators/
/// linearly_implicit_midpoint.cpp.
inline constexpr LaneStage midpoint[] = {{.time = 0.5, .gamma = 0.5}};
/// The trapezoidal rule to t_n + 2 d h, then BDF2, as integrators/tr_bdf2.h:
///
///     v_1 = v_n + d h (a_0 + a_1),    v_2 = v_n + w h (a_0 + a_1) + d h a_2
///
/// and q by the same sums of velocities, in which 2 w + d = 1.
inline constexpr double d = 1 - std::numbers::sqrt2 / 2, w = std::numbers::sqrt2 / 4;
inline constexpr double both = 2 * w * d;  // by v_1, and by v_bar
inline constexpr LaneStage tr_bdf2[] = {
    {.time = 0, .gamma = 0},
    {.time = 2 * d, .gamma = d, .rate = {d, 0}, .drift = {d / 2, 0}},
    {.time = 1, .gamma = d, .rate = {w, w}, .drift = {both, both}}};
/// The comparison of order 3 of [Hosea, Shampine 1996, Appl. Numer. Math. 20, 21, table
/// 1], share and power as integrators/tr_bdf2.cpp: its velocities enter q by the
/// accelerations that made them, in which what cancels is left out.
inline constexpr std::array<double, 3> off{w - (1 - w) / 3, w - (3 * w + 1) / 3,
                                           d - d / 3};
inline constexpr LaneEstimate tr_bdf2_estimate{
    .rate = off,
    .drift = {off[1] * d + off[2] * w, off[1] * d + off[2] * w, off[2] * d},
    .falls = 3,
    .share = 1.2,
    .power = 1.25};

}  // namespace lane_stages

/// Of semi_implicit_euler one correction of backward_euler's stage, from a = 0.
inline LaneMethod lane_method(HeadMethod method) {
  switch (method) {
    case HeadMethod::semi_implicit_euler:
      return {.stages = lane_stages::backward_euler, .iterates = false};
    case HeadMethod::linearly_implicit_midpoint:
      return {.stages = lane_stages::midpoint,
              .iterates = false,
              .first_steps = 2,
              .accelerations = 2};
    case HeadMethod::tr_bdf2:
      return {.stages = lane_stages::tr_bdf2,
              .iterates = true,
              .first_steps = 1,
              .accelerations = 2,
              .estimate = &lane_stages::tr_bdf2_estimate};
    case HeadMethod::backward_euler:
      break;
  }
  return {.stages = lane_stages::backward_euler, .iterates = true, .accelerations = 1};
}

}  // namespace tress::models
