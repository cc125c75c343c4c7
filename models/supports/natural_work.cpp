// Power and work of natural strains that move.
#include <algorithm>
#include <cmath>
#include <limits>

#include "models/supports/supported_system.h"

namespace tress::models {

/// A central difference, exact for the strains, in which the energy is quadratic. Half
/// edges turn by less than a radian in an interval: 1e-4 of that leaves an error of 1e-8.
double power_of_natural(std::span<SupportedSystem* const> strands, double t,
                        const std::function<double()>& potential) {
  constexpr double part = 1e-4;
  double shortest = std::numeric_limits<double>::infinity();
  for (const SupportedSystem* strand : strands) {
    const double interval = strand->natural().interval(t);
    if (interval > 0) shortest = std::min(shortest, interval);
  }
  if (!std::isfinite(shortest)) return 0;
  const auto at = [&](double ahead) {
    for (SupportedSystem* strand : strands) strand->prepare_beyond(t, ahead);
    return potential();
  };
  const double ahead = part * shortest, change = at(ahead) - at(-ahead);
  for (SupportedSystem* strand : strands) strand->prepare(t);
  return change / (2 * ahead);
}

NaturalWork work_of_natural(std::span<SupportedSystem* const> strands, double from,
                            double to, const std::function<double(bool)>& potential) {
  const bool moves = std::ranges::any_of(strands, [&](const SupportedSystem* strand) {
    return strand->natural().moves(from, to);
  });
  if (!moves) return {};
  const auto at = [&](double t, bool end) {
    for (SupportedSystem* strand : strands) strand->prepare(t);
    return potential(end);
  };
  const double before_at_start = at(from, false), before_at_end = at(from, true),
               after_at_start = at(to, false), after_at_end = at(to, true);
  return {after_at_start - before_at_start, after_at_end - before_at_end};
}

}  // namespace tress::models
