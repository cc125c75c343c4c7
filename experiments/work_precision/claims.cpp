#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "experiments/work_precision/work_precision.h"

namespace tress::experiments::work_precision {
namespace {

/// Most correct digits that a method reaches on a problem.
struct Digits {
  std::optional<double> most;  // empty: not run
  bool complete = true;        // no run was cut by its work limit
};

Digits best_digits(const std::vector<Row>& rows, std::string_view scene,
                   std::string_view integrator) {
  Digits best;
  for (const Row& row : rows) {
    if (row.text("scene") != scene || row.text("integrator") != integrator) continue;
    best.most = std::max(best.most.value_or(0), row.ok() ? row.number("scd") : 0);
    best.complete = best.complete && row.status() != "gave_up";
  }
  return best;
}

/// At least `least` methods reach six digits on a problem. This number suffices to
/// confirm the claim; to refute it, all of them must have been run to the end.
struct DigitsClaim {
  std::string_view claim, scene;
  std::vector<std::string_view> by;
  int least;
};

void check_digits(const std::vector<Row>& rows, const DigitsClaim& claim,
                  Verdicts& verdicts) {
  int enough = 0;
  bool complete = true;
  for (const std::string_view id : claim.by) {
    const Digits digits = best_digits(rows, claim.scene, id);
    complete = complete && digits.most && digits.complete;
    if (digits.most.value_or(0) >= 6) ++enough;
  }
  verdicts.check_found(std::string(claim.claim), enough >= claim.least, complete, enough);
}

void check_order(const std::vector<Row>& rows, std::string_view model,
                 Verdicts& verdicts) {
  const std::string claim =
      std::string(model) + ": total error falls at order 2 in element length";
  const auto total = std::ranges::find_if(rows, [&](const Row& row) {
    return row.text("model") == model && row.text("error_kind") == "total" &&
           row.has("order_fit");
  });
  if (total == rows.end()) {
    verdicts.not_judged(claim);
    return;
  }
  const double order = total->number("order_fit");
  verdicts.check(claim, order >= 1.8, order);
}

double steps_of(const std::vector<Row>& rows, int order, double rtol) {
  for (const Row& row : rows) {
    if (row.text("scene") == "beam" && row.text("integrator") == "cvode_bdf" &&
        row.number("max_order") == order &&
        std::abs(row.number("rtol") / rtol - 1) < 1e-6) {
      return row.number("steps");
    }
  }
  return std::nan("");
}

/// At 1e-3 and 1e-4 the outcome depends on how far Newton's iteration goes: 200 steps or
/// 40 000.
void check_bdf(const std::vector<Row>& rows, Verdicts& verdicts) {
  const double second = steps_of(rows, 2, 1e-5);
  const double fifth = steps_of(rows, 5, 1e-5);
  const std::string claim =
      "BDF up to order 5 needs over ten times the steps of order 2 at rtol 1e-5";
  if (std::isnan(second) || std::isnan(fifth)) {
    verdicts.not_judged(claim);
  } else {
    verdicts.check(claim, fifth > 10 * second, fifth / second);
  }
}

}  // namespace

void check_claims(const std::vector<Row>& rows, Verdicts& verdicts) {
  check_digits(rows,
               {"Andrews' squeezer: 6 correct digits from ida or an implicit method",
                "andrews_squeezer",
                {"ida", "generalized_alpha", "newmark", "bdf2"},
                1},
               verdicts);
  check_digits(rows,
               {"Beam: 6 correct digits from two integrators",
                "beam",
                {"ida", "rk4", "gsl_rk8pd", "gsl_msadams", "cvode_adams"},
                2},
               verdicts);
  for (const std::string_view model : {"super_helix", "articulated_chain"}) {
    check_order(rows, model, verdicts);
  }
  check_bdf(rows, verdicts);
  check_swing_claims(rows, verdicts);
  check_tolerances(rows, verdicts);
}

}  // namespace tress::experiments::work_precision
