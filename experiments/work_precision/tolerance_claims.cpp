#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <string_view>

#include "experiments/work_precision/work_precision.h"

namespace tress::experiments::work_precision {
namespace {

// Achieved over asked: above 1 the promise is broken, below 0.05 the run took
// steps more than four times too short at order 2. What is below depends on the ladder,
// and is no claim.
constexpr double least_ratio = 0.05, most_ratio = 1;
constexpr double loosest = 1e-2, tightest = 1e-4;

/// Error control on one strand, and where it is known not to keep its promise.
struct ControlClaim {
  std::string_view scene, integrator;
  double most = 0;  // of the largest ratio; 0: it keeps it
  std::string_view reason = {};
};

constexpr ControlClaim claims[] = {
    {strand_release.name, "bdf2"},
    {strand_release.name, "tr_bdf2"},
    {strand_release.name, "esdirk43"},
    {strand_release.name, "generalized_alpha"},
    {swing.name, "tr_bdf2", 2.5,
     "the error of an undamped motion grows with time, and at order 2 falls as the "
     "tolerance to the power 5/6"},
    {swing.name, "esdirk43"},
};

/// A curve: achieved error for each tolerance.
using Errors = std::map<double, double>;

bool falls(const Errors& errors) {
  return std::ranges::is_sorted(errors, {}, [](const auto& one) { return one.second; });
}

/// By model, of the runs that succeeded within the range of the claim.
std::map<std::string, Errors> curves(const std::vector<Row>& rows,
                                     const ControlClaim& claim) {
  std::map<std::string, Errors> all;
  for (const Row& row : rows) {
    if (!row.ok() || !row.has("error_over_tolerance")) continue;
    if (row.text("scene") != claim.scene || row.text("integrator") != claim.integrator) {
      continue;
    }
    const double tolerance = row.number("position_tol_rel");
    if (tolerance > 1.01 * loosest || tolerance < 0.99 * tightest) continue;
    all[joined(row, {"model", "modes", "elements"})][tolerance] =
        tolerance * row.number("error_over_tolerance");
  }
  return all;
}

void check(const std::vector<Row>& rows, const ControlClaim& claim, Verdicts& verdicts) {
  const std::string who =
      std::string(claim.integrator) + ", " + std::string(claim.scene) + ": ";
  const std::string words = who +
                            "time error is at most the tolerance from 1e-2 to 1e-4 and "
                            "falls with it, for all models that run";
  double largest = 0, within = 0, runs = 0;
  bool falling = true;
  for (const auto& [model, errors] : curves(rows, claim)) {
    falling = falling && falls(errors);
    for (const auto& [tolerance, error] : errors) {
      const double ratio = error / tolerance;
      largest = std::max(largest, ratio);
      ++runs;
      if (ratio >= least_ratio && ratio <= most_ratio) ++within;
    }
  }
  if (runs == 0) {
    verdicts.not_judged(words);
    return;
  }
  const bool held = falling && largest <= most_ratio;
  if (claim.reason.empty()) {
    verdicts.check(words, held, largest);
  } else {
    verdicts.check_known(words, held, largest,
                         {words, most_ratio, claim.most, claim.reason});
  }
  verdicts.figure(who + "share of runs with 0.05 to 1 of the tolerance", within / runs);
}

}  // namespace

void check_tolerances(const std::vector<Row>& rows, Verdicts& verdicts) {
  for (const ControlClaim& claim : claims) check(rows, claim, verdicts);
}

}  // namespace tress::experiments::work_precision
