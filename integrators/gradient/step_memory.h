#pragma once

#include <string>
#include <string_view>

#include "contract/integrator.h"

namespace tress::integrators {

/// Returns whether a step of the method depends on the steps before it, not on its start
/// (t, q, v) alone. Compares the next step of a run of an oscillator with the first step
/// of a run that starts at the same state.
bool remembers_steps(std::string_view method);

/// Returns whether the method passes the solutions of its stages to a StageWatcher, as
/// Stage does.
bool shows_stages(std::string_view method);

/// Returns whether the method computes accelerations from the state at its start.
bool starts_from_accelerations(std::string_view method);

/// Why the steps of a method cannot be transposed, and what its author must do; empty:
/// they can. FixedStep::state() and numbers() must be all that the next step depends on.
std::string no_transposed_steps(std::string_view method, const Options& options);

}  // namespace tress::integrators
