#pragma once

#include <string_view>

namespace tress::integrators {

/// Returns whether a step of the method depends on the steps before it, not on its start
/// (t, q, v) alone. Compares the next step of a run of an oscillator with the first step
/// of a run that starts at the same state.
bool remembers_steps(std::string_view method);

}  // namespace tress::integrators
