#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>

namespace tress::integrators {

/// A stage of a step of length h from (q_n, v_n) at t_n, of a diagonally implicit
/// Runge-Kutta method for q' = v, v' = a, without the velocities of its stages:
///
///     r(t_n + time h, q, v, a) = 0
///     v = v_bar + gamma h a,        v_bar = v_n + h (rate[0] a_0 + rate[1] a_1)
///     q = q_bar + (gamma h)^2 a,    q_bar = q_n + time h u,
///                                   u = v_n + h (drift[0] a_0 + drift[1] a_1)
///
/// a_0: the acceleration at t_n, a_1: that of the stage before.
struct BlockStage {
  double time = 1, gamma = 1;  // c_i of the stage, and its diagonal coefficient
  std::array<double, 2> rate{}, drift{};  // weights of a_0 and a_1 in v_bar and in u
};

/// Difference between the last stage's state and one of higher order from the same
/// stages: h^2 sum drift[i] a_i in q, h sum rate[i] a_i in v. The difference falls as
/// h^falls. The threshold of a step in the norm of BlockError is share tolerance^power.
struct BlockEstimate {
  std::array<double, 3> rate, drift;  // weights of a_0, a_1 and a_2 in v and in q
  double falls, share, power;         // order in h; numbers of the threshold

  /// Returns the largest estimate that is accepted at a tolerance.
  double threshold(double tolerance) const { return share * std::pow(tolerance, power); }
};

/// A method by its stages. Where the first has gamma = 0 it is the last one of the step
/// before, and is solved in a strand's first step alone. The step ends with the last
/// stage's (q, v) if that is at its end, and else with
///
///     q_n + h v,    v_n + h a
struct BlockMethod {
  std::span<const BlockStage> stages;  // stages in order
  bool iterates;  // in every step; false: one correction solves a stage
  /// Number of first steps of a strand that differ from the following ones. They solve
  /// the first stage, which later steps take from the step before, or iterate where later
  /// steps do not.
  std::size_t first_steps = 0;
  /// Number of last accelerations that are kept of a strand; with two, also the lengths
  /// of both steps.
  std::size_t accelerations = 0;
  const BlockEstimate* estimate = nullptr;  // null: it has none

  /// The first stage that every step solves.
  std::size_t first() const { return stages[0].gamma == 0 ? 1 : 0; }
  /// Whether a step is one correction from a = 0 with the matrix there.
  bool linear() const { return !iterates && accelerations == 0; }
  /// Returns how many numbers the state of a strand of `unknowns` coordinates has.
  std::size_t of_state(std::size_t unknowns) const {
    return (2 + accelerations) * unknowns + (accelerations == 2 ? 2 : 0);
  }
};

/// Methods that blocks have, by the ids of their integrators.
enum class HeadMethod {
  linearly_implicit_euler,     // order 1, one correction a step
  linearly_implicit_midpoint,  // order 2, one correction a step
  backward_euler,              // order 1
  tr_bdf2                      // order 2, with an estimate of the error
};
/// Returns the stages of a method.
BlockMethod block_method(HeadMethod method);

/// The estimate of tr_bdf2, the method whose steps a tolerance chooses.
extern const BlockEstimate tr_bdf2_estimate;

}  // namespace tress::integrators
