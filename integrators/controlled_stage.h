#pragma once

#include <limits>

#include "integrators/entry.h"
#include "integrators/stage/stage.h"

namespace tress::integrators {

/// Throws InputError if a method cannot control the error of this system: no method can
/// with index 3, and some cannot with the contact forces of System::contact_form().
void check_controlled(System& system, const Options& options,
                      Contact of_method = Contact::exact);

/// Returns `options` with Newton's tolerance and the reuse of its matrix for stages of a
/// run with Options::tolerance. `threshold`: the estimate that a step may have, for
/// methods of order 2, whose thresholds become much smaller than the tolerance.
Options controlled_options(Dynamics& dynamics, Options options,
                           double threshold = std::numeric_limits<double>::infinity());

/// Power of the step with which the estimate of a method of order 2 falls.
inline constexpr double second_order_power = 3;
/// Returns the estimate that a step of such a method may have, (share tolerance)^(3/2).
/// The error of a run is then proportional to the tolerance (EsdirkTable::power).
double second_order_threshold(const Options& options, double share);

/// Returns the convergence criteria of such stages. Newton's tolerance has its margin
/// already.
Stage::Ending controlled_ending(Dynamics& dynamics);

}  // namespace tress::integrators
