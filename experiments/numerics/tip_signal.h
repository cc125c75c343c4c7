#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "contract/integrator.h"
#include "simulation/run/guard.h"

namespace tress::experiments {

/// The displacement of a strand's tip from its root along one axis, at the start and
/// after every step of a run from the initial state.
struct TipSignal {
  Status status = Status::ok;
  std::string failure;
  std::vector<double> t, x, v;  // s, m, m/s
};

/// `axis`: 0, 1, 2 for x, y, z. A breach of `guard`, if given, ends the run.
TipSignal run_tip_signal(std::string_view integrator, System& system,
                         const Options& options, int axis, double t_end,
                         Guard* guard = nullptr);

/// Displacement at `times`, all within the run, by cubic Hermite interpolation over each
/// step: error (omega h)^4/384 for an oscillation of rate omega at steps h.
std::vector<double> displacement(const TipSignal& signal, In times);

/// Half the difference of successive turning points, midway between them. Turning points
/// of ripples on a larger swing are skipped, as in rainflow counting (ASTM E1049). These
/// are the ones between which the signal moves less than before and after, and, at the
/// beginning, less than after.
struct Swings {
  std::vector<double> t, half;  // s, m
};
Swings swings(const TipSignal& signal);

/// Envelope at `times`, by straight lines of ln(half) through the swings, extrapolated
/// beyond the first and the last: exact for the exponential decay of one mode. Empty when
/// there are fewer than two swings.
std::vector<double> envelope(const TipSignal& signal, In times);

}  // namespace tress::experiments
