#pragma once

#include <functional>
#include <vector>

#include "experiments/calibrate/friction_fit.h"

namespace tress::experiments::calibrate {

/// Decay rate (1/s) of a record, exp(-rate t): logarithmic decrement between the root
/// mean squares of its halves about the common mean, over the time between them. 0 when
/// it grows.
double decay_rate(const Record& record, Observed observed);

/// Initial guess of a fit. Drag alone that matches the decay: nu = 2 m rate, m the mass
/// per length, whatever the mode. Friction alone: that of a straight strand's first mode,
/// gamma = 2 m rate (L/1.8751)^4, or tenths of it (a curl needs less), whichever has the
/// least `misfit` (NaN: none). Both: half of each.
Friction friction_start(const Records& records, const std::vector<Specimen>& strands,
                        Observed observed, Fitted fitted,
                        const std::function<double(const Friction&)>& misfit);

}  // namespace tress::experiments::calibrate
