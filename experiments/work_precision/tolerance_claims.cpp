#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <string_view>

#include "experiments/work_precision/work_precision.h"

namespace tress::experiments::work_precision {
namespace {

constexpr double least_ratio = 0.05, most_ratio = 1;  // achieved over asked
constexpr double loosest = 1e-2, tightest = 1e-4;

/// Error control on one strand, and where it is known not to keep to the bounds.
struct ControlClaim {
  std::string_view scene, integrator;
  double least = 0, most = 0;  // of the ratio farthest outside; 0: none is
  std::string_view reason = {};
};

constexpr std::string_view few_steps =
    "at 1e-2 a quarter of a second is a few steps of a smooth start: some models stay "
    "further below the tolerance than a twentieth";

constexpr ControlClaim claims[] = {
    {strand_release.name, "tr_bdf2", 0.01, least_ratio, few_steps},
    {strand_release.name, "esdirk43", 0.01, least_ratio, few_steps},
    {swing.name, "tr_bdf2", most_ratio, 2.5,
     "the error of an undamped motion grows with time, and at order 2 falls as the "
     "tolerance to the power 5/6"},
    {swing.name, "esdirk43"},
};

double factor_outside(double ratio) {
  return std::max({1.0, least_ratio / ratio, ratio / most_ratio});
}

/// A curve: achieved errors by tolerance.
using Errors = std::map<double, double>;

bool falls(const Errors& errors) {
  return std::ranges::is_sorted(errors, {}, [](const auto& one) { return one.second; });
}

/// By model, of the runs that succeeded within the range of the claim.
std::map<std::string, Errors> curves(const std::vector<Row>& rows,
                                     const ControlClaim& claim) {
  std::map<std::string, Errors> all;
  for (const Row& row : rows) {
    if (!row.ok() || !row.has("achieved_over_asked")) continue;
    if (row.text("scene") != claim.scene || row.text("integrator") != claim.integrator) {
      continue;
    }
    const double tolerance = row.number("tolerance");
    if (tolerance > 1.01 * loosest || tolerance < 0.99 * tightest) continue;
    all[joined(row, {"model", "modes", "elements"})][tolerance] =
        tolerance * row.number("achieved_over_asked");
  }
  return all;
}

void check(const std::vector<Row>& rows, const ControlClaim& claim, Verdicts& verdicts) {
  const std::string words = std::string(claim.integrator) + ", " +
                            std::string(claim.scene) +
                            ": time error is 0.05 to 1 of the tolerance from 1e-2 to "
                            "1e-4 and falls with it, by "
                            "all models that run";
  double worst = std::nan("");
  bool falling = true;
  for (const auto& [model, errors] : curves(rows, claim)) {
    falling = falling && falls(errors);
    for (const auto& [tolerance, error] : errors) {
      const double ratio = error / tolerance;
      if (std::isnan(worst) || factor_outside(ratio) > factor_outside(worst)) {
        worst = ratio;
      }
    }
  }
  if (std::isnan(worst)) {
    verdicts.not_judged(words);
    return;
  }
  const bool held = falling && factor_outside(worst) == 1;
  if (claim.reason.empty()) {
    verdicts.check(words, held, worst);
  } else {
    verdicts.check_known(words, held, worst,
                         {words, claim.least, claim.most, claim.reason});
  }
}

}  // namespace

void check_tolerances(const std::vector<Row>& rows, Verdicts& verdicts) {
  for (const ControlClaim& claim : claims) check(rows, claim, verdicts);
}

}  // namespace tress::experiments::work_precision
