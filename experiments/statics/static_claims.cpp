#include "experiments/statics/static_claims.h"

#include <cmath>
#include <numbers>
#include <string_view>

namespace tress::experiments::statics {
namespace {

using simulation::Row;

// P R^2/EI at which an arch of 215 degrees, clamped and hinged, loses stability under a
// force at its crown [DaDeppo & Schmidt 1975, J. Appl. Mech. 42, 894]: 8.97.
constexpr double deep_arch = 8.97;
// P L^2/EI of a column that is clamped and free [Euler 1744].
constexpr double column = std::numbers::pi * std::numbers::pi / 4;
constexpr double wanted_accuracy = 0.005;

/// Relative error of the first event of a scene; NaN: the scene was not run.
double error_of(const std::vector<Row>& rows, std::string_view scene,
                std::string_view event, double expected) {
  bool there = false;
  for (const Row& row : rows) {
    if (row.text("scene") != scene) continue;
    there = true;
    if (row.text("event") == event) {
      return std::abs(row.number("parameter") / expected - 1);
    }
  }
  return there ? 1 : std::nan("");
}

void check_load(Verdicts& verdicts, const char* claim, double error) {
  if (std::isnan(error)) return verdicts.not_judged(claim);
  verdicts.check(claim, error <= wanted_accuracy, error);
}

}  // namespace

void judge(const std::vector<Row>& rows, Verdicts& verdicts) {
  check_load(verdicts, "the limit load of the deep arch is within 0.5 % of 8.97 EI/R^2",
             error_of(rows, "deep_arch", "limit_point", deep_arch));
  check_load(verdicts, "the column buckles within 0.5 % of Euler's load",
             error_of(rows, "column", "bifurcation", column));
}

}  // namespace tress::experiments::statics
