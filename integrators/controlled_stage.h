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

/// Returns the convergence criteria of such stages. Newton's tolerance has its margin
/// already.
Stage::Ending controlled_ending(Dynamics& dynamics);

}  // namespace tress::integrators
