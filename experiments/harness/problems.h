#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/harness/simulation.h"

namespace tress {

struct ProblemError {
  double relative;  // largest error over the problem's length scale
  double scd;       // -log10 of the largest entry-wise relative error
};

/// A problem whose end state is known: exactly, as published, or from two integrators of
/// different families whose disagreement is kept as the reference's own error.
struct Problem {
  std::string_view name;
  std::string_view model;
  ModelSettings settings;
  double t_end;        // s
  double coarse_step;  // s, the loosest fixed step worth trying
  double scale;        // of the compared values
  std::vector<double> reference;
  double reference_gap;  // relative to scale

  /// What is compared: coordinates, or material points where form must not matter.
  std::function<std::vector<double>(System&, const State&)> compared;

  std::unique_ptr<System> make() const { return make_model(model, settings); }
  ProblemError error(System& system, const State& end) const;
};

/// Made once, at the first call; the doubly computed references take about a second.
std::span<const Problem> problems();

}  // namespace tress
