#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <string>
#include <string_view>

#include "experiments/problems/reference.h"
#include "experiments/work_precision/work_precision.h"

namespace tress::experiments::work_precision {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Its runs alone reach every target error used here.
constexpr std::string_view sure = "implicit_midpoint";

/// Checks that some run meets an error, and reports its time.
void check_target(const std::vector<Row>& rows, std::string_view kind, double error,
                  const std::string& what, Verdicts& verdicts) {
  const Row* best = nullptr;
  double least = infinity;
  bool complete = false;
  for (const Row& row : rows) {
    if (row.text("error_kind") != kind) continue;
    if (kind == "time" && row.number("elements") != simulator_elements) continue;
    complete = complete || row.text("integrator") == sure;
    if (!row.ok()) continue;
    least = std::min(least, row.number("error_rel"));
    if (row.number("error_rel") > error) continue;
    if (best == nullptr || row.number("wall_s") < best->number("wall_s")) best = &row;
  }
  verdicts.check_found("some run has " + what, best != nullptr, complete, least);
  if (best == nullptr) return;
  verdicts.figure("seconds to " + what + ", " + std::string(best->text("integrator")),
                  best->number("wall_s"));
}

/// The time error of a run with converged steps, by all identifying columns except the
/// modes.
std::map<std::string, double> converged_errors(const std::vector<Row>& rows,
                                               std::string_view modes) {
  constexpr double converged = 1e-8;  // newton_tolerance
  std::map<std::string, double> errors;
  for (const Row& row : rows) {
    if (row.text("error_kind") != "time" || row.text("modes") != modes) continue;
    if (!row.ok() || !(row.number("newton_tolerance") <= converged)) continue;
    errors[joined(row, {"model", "solver", "jacobian", "integrator", "newton_tolerance",
                        "elements", "dt_s"})] = row.number("error_rel");
  }
  return errors;
}

/// Checks that twist does not matter. Bending moments of a section that bends equally in
/// all directions have no component along the tangent. Only the section's rotational
/// inertia, (r/L)^2 of the strand's, therefore twists a straight strand that starts
/// without twist.
void check_twist(const std::vector<Row>& rows, Verdicts& verdicts) {
  constexpr double least = 1e-4;  // smaller errors include rounding
  double worst = 0;
  bool any = false;
  const auto bend = converged_errors(rows, "bend");
  for (const auto& [key, error] : converged_errors(rows, "bend_twist")) {
    const auto other = bend.find(key);
    if (other == bend.end() || other->second < least || other->second > 0.01) continue;
    any = true;
    worst = std::max(worst, std::abs(error / other->second - 1));
  }
  const std::string claim =
      "converged steps: bend and bend_twist have the same error to 5 %";
  if (any) {
    verdicts.check(claim, worst <= 0.05, worst);
  } else {
    verdicts.not_judged(claim);
  }
}

void check_references(const std::vector<Row>& rows, std::string_view kind, double bound,
                      const std::string& claim, Verdicts& verdicts) {
  double gap = -1;
  for (const Row& row : rows) {
    if (row.text("error_kind") == kind && row.has("reference_gap")) {
      gap = std::max(gap, row.number("reference_gap"));
    }
  }
  if (gap >= 0) {
    verdicts.check(claim, gap <= bound, gap);
  } else {
    verdicts.not_judged(claim);
  }
}

}  // namespace

void check_swing_claims(const std::vector<Row>& all, Verdicts& verdicts) {
  std::vector<Row> rows;
  std::ranges::copy_if(all, std::back_inserter(rows),
                       [](const Row& row) { return row.text("scene") == swing.name; });
  check_target(rows, "time", 0.01, "1 % time error with 20 elements", verdicts);
  check_target(rows, "time", 0.001, "0.1 % time error with 20 elements", verdicts);
  check_target(rows, "total", 0.01, "1 % total error", verdicts);
  check_twist(rows, verdicts);
  // A tenth of the smallest error in a claim.
  check_references(rows, "time", 1e-3 / ReferenceGap::margin,
                   "time: Runge-Kutta and Adams agree to 0.01 %", verdicts);
  check_references(rows, "total", 1e-3 / ReferenceGap::margin,
                   "rod: super-helices and articulated chains agree to 0.01 %", verdicts);
}

}  // namespace tress::experiments::work_precision
