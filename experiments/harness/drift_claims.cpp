#include "experiments/harness/drift_claims.h"

#include <algorithm>
#include <limits>
#include <string>
#include <string_view>

namespace tress {
namespace {

const Row* find(const std::vector<Row>& rows, std::string_view study,
                std::string_view system, std::string_view formulation,
                std::string_view integrator) {
  for (const Row& row : rows) {
    if (row.text("study") == study && row.text("system") == system &&
        row.text("formulation") == formulation && row.text("integrator") == integrator) {
      return &row;
    }
  }
  return nullptr;
}

double best_feedback(const std::vector<Row>& rows, std::string_view integrator) {
  double best = std::numeric_limits<double>::infinity();
  for (const Row& row : rows) {
    if (row.text("study") == "grid" && row.text("integrator") == integrator &&
        row.text("formulation") == "baumgarte" && row.ok()) {
      best = std::min(best, row.number("g_max"));
    }
  }
  return best;
}

/// Slightly less than critical damping may cross the threshold sooner, at the price of an
/// overshoot; without overshoot nothing is faster than critical damping.
void check_recovery(const std::vector<Row>& rows, Verdicts& verdicts) {
  constexpr double overshoots = 1e-6;  // of the violation, the threshold of recovery
  for (const Row& critical : rows) {
    const double alpha = critical.number("alpha");
    const double beta = critical.number("beta");
    if (critical.text("study") != "recovery" || !(beta * beta == 4 * alpha)) continue;
    double fastest_other = std::numeric_limits<double>::infinity();
    for (const Row& row : rows) {
      if (row.text("study") != "recovery" || row.number("alpha") != alpha) continue;
      if (row.number("beta") == beta || row.number("overshoot") > overshoots) continue;
      fastest_other = std::min(fastest_other, row.number("recovery_time_s"));
    }
    const double ratio = critical.number("recovery_time_s") / fastest_other;
    verdicts.check(
        "critical damping recovers fastest of all that do not overshoot, alpha " +
            std::string(critical.text("alpha")),
        ratio < 1, ratio);
  }
}

/// The first seed's claim: corrected lengths where springs, solved once a step, give way.
void check_strands(const std::vector<Row>& rows, Verdicts& verdicts) {
  for (const Row& row : rows) {
    if (row.text("study") != "strands" || !row.ok() || row.number("dt_s") < 5e-3)
      continue;
    const double error = row.number("length_error_rel");
    if (row.text("integrator") == "predictor_corrector") {
      verdicts.check("shaken " + std::string(row.text("system")) + " " +
                         std::string(row.text("variant")) +
                         ", predictor_corrector at 1/120 s: lengths within 1e-6",
                     error <= 1e-6, error);
    }
    if (row.text("system") == "mass_spring" &&
        row.text("integrator") == "semi_implicit_euler") {
      verdicts.check("shaken mass_spring, one solve a step: stretches by over 1 %",
                     error > 0.01, error);
    }
  }
}

}  // namespace

void check_drift_claims(const std::vector<Row>& rows, Verdicts& verdicts) {
  check_strands(rows, verdicts);
  const Row* drifting =
      find(rows, "grid", "circle bead", "acceleration", "symplectic_euler");
  if (drifting != nullptr) {
    const double gain =
        drifting->number("g_max") / best_feedback(rows, "symplectic_euler");
    verdicts.check("symplectic_euler: the best Baumgarte pair drifts 30 x less",
                   gain >= 30, gain);
  }
  check_recovery(rows, verdicts);
  for (const Row& row : rows) {
    if (row.text("study") != "formulation" || !row.ok()) continue;
    const std::string what =
        std::string(row.text("system")) + ", " + std::string(row.text("integrator"));
    if (row.text("system") == "circle bead" && (row.text("formulation") == "projection" ||
                                                row.text("formulation") == "rattle")) {
      verdicts.check(what + ", projected: drift at most 1e-10 m",
                     row.number("g_max") <= 1e-10, row.number("g_max"));
    }
    if (row.text("formulation") == "parametric") {
      verdicts.check(what + ", parametric: no drift", row.number("g_max") <= 1e-15,
                     row.number("g_max"));
    }
    if (row.text("formulation") == "index2_ggl" &&
        row.text("suppress_algebraic") == "true" && row.text("system") == "circle bead") {
      verdicts.check(what + ", index 2: drift at most 10 rtol",
                     row.number("g_max") <= 10 * row.number("rtol"), row.number("g_max"));
    }
  }
}

}  // namespace tress
