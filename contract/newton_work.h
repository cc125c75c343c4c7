#pragma once

namespace tress {

/// Newton's iterations of steps: of strands, and of lanes, those without a strand
/// included.
struct NewtonWork {
  long steps = 0;                              // of strands
  long iterations = 0, lanes = 0;              // whole corrections, strands side by side
  long retried = 0;                            // steps of strands on which they failed
  long again_iterations = 0, again_lanes = 0;  // of these, damped
  long in_parts = 0;                           // of the last, iterations of shorter steps
  long shortened = 0;                          // steps of strands taken in shorter ones
  long replaced = 0;                           // backward Euler steps in place of others
  // With a tolerance, steps of strands that were tried again with shorter ones.
  long rejected_by_error = 0;   // steps whose estimated error was too large
  long rejected_by_newton = 0;  // steps without a solution

  /// Adds the counts of other steps.
  NewtonWork& operator+=(const NewtonWork& more) {
    steps += more.steps;
    iterations += more.iterations;
    lanes += more.lanes;
    retried += more.retried;
    again_iterations += more.again_iterations;
    again_lanes += more.again_lanes;
    in_parts += more.in_parts;
    shortened += more.shortened;
    replaced += more.replaced;
    rejected_by_error += more.rejected_by_error;
    rejected_by_newton += more.rejected_by_newton;
    return *this;
  }
};

}  // namespace tress
