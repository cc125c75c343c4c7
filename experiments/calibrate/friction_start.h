#pragma once

#include <functional>
#include <vector>

#include "experiments/calibrate/friction_fit.h"

namespace tress::experiments::calibrate {

/// Rate (1/s) of the decay exp(-rate t) of a record: the logarithmic decrement of its
/// halves' root mean squares about the mean of all, over the time between them. 0 when it
/// grows.
double decay_rate(const Record& record, Observed observed);

/// Where to begin a fit. Drag alone that makes the records decay as they do: nu = 2 m
/// rate, m the mass per length, whatever the mode. Friction alone: that of a straight
/// strand's first mode, gamma = 2 m rate (L/1.8751)^4, and tenths of it (of a curl less
/// is needed), whichever has the least `misfit` (NaN: none). Both: half of each.
Friction friction_start(const Records& records, const std::vector<Specimen>& strands,
                        Observed observed, Fitted fitted,
                        const std::function<double(const Friction&)>& misfit);

}  // namespace tress::experiments::calibrate
