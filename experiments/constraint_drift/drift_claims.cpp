#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>

#include "experiments/constraint_drift/constraint_drift.h"

namespace tress::experiments::constraint_drift {
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

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Over all pairs of gains that were run, and whether any was.
struct Feedback {
  double best = infinity;
  bool run = false;
};

Feedback feedback(const std::vector<Row>& rows, std::string_view integrator) {
  Feedback found;
  for (const Row& row : rows) {
    if (row.text("study") != "grid" || row.text("integrator") != integrator ||
        row.text("formulation") != "baumgarte") {
      continue;
    }
    found.run = true;
    if (row.ok()) found.best = std::min(found.best, row.number("g_max"));
  }
  return found;
}

void check_feedback(const std::vector<Row>& rows, Verdicts& verdicts) {
  const std::string claim =
      "symplectic_euler: the best Baumgarte pair reduces the drift 30 times or more";
  const Row* drifting =
      find(rows, "grid", "circle bead", "acceleration", "symplectic_euler");
  const Feedback fed = feedback(rows, "symplectic_euler");
  if (drifting == nullptr || !fed.run) {
    verdicts.not_judged(claim);
    return;
  }
  const double gain = drifting->number("g_max") / fed.best;
  verdicts.check(claim, gain >= 30, gain);
}

/// Slightly less than critical damping may cross the threshold sooner, at the price of an
/// overshoot; without overshoot nothing is faster than critical damping.
void check_recovery(const std::vector<Row>& rows, Verdicts& verdicts) {
  constexpr double overshoots = 1e-6;  // relative to the violation, the threshold of
                                       // recovery
  const std::string claim =
      "critical damping recovers fastest of all dampings that do not overshoot";
  bool any = false;
  for (const Row& critical : rows) {
    const double alpha = critical.number("alpha");
    const double beta = critical.number("beta");
    if (critical.text("study") != "recovery" || !(beta * beta == 4 * alpha)) continue;
    double fastest_other = infinity;
    bool compared = false;
    for (const Row& row : rows) {
      if (row.text("study") != "recovery" || row.number("alpha") != alpha) continue;
      if (row.number("beta") == beta || row.number("overshoot") > overshoots) continue;
      compared = true;
      fastest_other = std::min(fastest_other, row.number("recovery_time_s"));
    }
    if (!compared) continue;
    any = true;
    const double ratio = critical.number("recovery_time_s") / fastest_other;
    verdicts.check(claim + ", alpha " + std::string(critical.text("alpha")), ratio < 1,
                   ratio);
  }
  if (!any) verdicts.not_judged(claim);
}

void check_limits(const std::vector<Row>& rows, Verdicts& verdicts) {
  bool any = false;
  for (const Row& row : rows) {
    if (!row.has("rel_gap")) continue;
    any = true;
    const double gap = row.number("rel_gap");
    verdicts.check(std::string(row.text("integrator")) + ", zeta " +
                       std::string(row.text("zeta")) + ": limit within 5 % of theory",
                   std::abs(gap) <= 0.05, gap);
  }
  if (!any) verdicts.not_judged("explicit methods: limit within 5 % of theory");
}

/// Strands that predictor_corrector does not complete at 1/120 s, and after how many of
/// the 60 steps they stop.
constexpr std::string_view stops =
    "a step of 1/120 s has no solution; at 1 ms, or with linear springs, lengths hold";
constexpr KnownLimit stopped[] = {{"der stretch=inextensible", 0, 59, stops},
                                  {"inextensible_strand ", 0, 59, stops}};

void check_corrected(const Row& row, Verdicts& verdicts) {
  const std::string strand =
      std::string(row.text("system")) + " " + std::string(row.text("variant"));
  const std::string claim =
      "shaken " + strand + ", predictor_corrector at 1/120 s: lengths within 1e-6";
  const double error = row.number("length_error_rel");
  const bool held = row.ok() && error <= 1e-6;
  const auto known = std::ranges::find(stopped, strand, &KnownLimit::claim);
  if (known == std::end(stopped)) {
    verdicts.check(claim, held, error);
  } else {
    verdicts.check_known(claim, held, row.number("steps"), *known);
  }
}

/// The claim that length correction holds where springs, solved once a step, yield. A
/// failed run does not count as keeping lengths.
void check_strands(const std::vector<Row>& rows, Verdicts& verdicts) {
  bool corrected = false, stretched = false;
  for (const Row& row : rows) {
    if (row.text("study") != "strands" || row.number("dt_s") < 5e-3) continue;
    const double error = row.number("length_error_rel");
    if (row.text("integrator") == "predictor_corrector") {
      corrected = true;
      check_corrected(row, verdicts);
    }
    if (row.text("system") == "mass_spring" &&
        row.text("integrator") == "linearly_implicit_euler") {
      stretched = true;
      verdicts.check("shaken mass_spring, one solve a step: stretches by over 1 %",
                     row.ok() && error > 0.01, error);
    }
  }
  if (!corrected) {
    verdicts.not_judged("shaken, predictor_corrector at 1/120 s: lengths within 1e-6");
  }
  if (!stretched) {
    verdicts.not_judged("shaken mass_spring, one solve a step: stretches by over 1 %");
  }
}

/// Claim of the study of formulations about a system: largest violation allowed in each
/// row that `speaks_of` selects.
struct DriftClaim {
  std::string_view words;  // follows the names of system and method
  bool (*speaks_of)(const Row&);
  double (*most)(const Row&);
};

bool on_circle(const Row& row) { return row.text("system") == "circle bead"; }

constexpr DriftClaim drift_claims[] = {
    {"projected: drift at most 1e-10 m",
     [](const Row& row) {
       return on_circle(row) && (row.text("formulation") == "projection" ||
                                 row.text("formulation") == "rattle");
     },
     [](const Row&) { return 1e-10; }},
    {"parametric: no drift",
     [](const Row& row) { return row.text("formulation") == "parametric"; },
     [](const Row&) { return 1e-15; }},
    {"index 2: drift at most 10 rtol",
     [](const Row& row) {
       return on_circle(row) && row.text("formulation") == "index2_ggl" &&
              row.text("suppress_algebraic") == "true";
     },
     [](const Row& row) { return 10 * row.number("rtol"); }},
};

void check_formulations(const std::vector<Row>& rows, Verdicts& verdicts) {
  for (const auto& [words, speaks_of, most] : drift_claims) {
    bool any = false;
    for (const Row& row : rows) {
      if (row.text("study") != "formulation" || !speaks_of(row)) continue;
      any = true;
      const double drift = row.number("g_max");
      verdicts.check(std::string(row.text("system")) + ", " +
                         std::string(row.text("integrator")) + ", " + std::string(words),
                     row.ok() && drift <= most(row), drift);
    }
    if (!any) verdicts.not_judged(std::string(words));
  }
}

}  // namespace

void check_drift_claims(const std::vector<Row>& rows, Verdicts& verdicts) {
  check_strands(rows, verdicts);
  check_feedback(rows, verdicts);
  check_recovery(rows, verdicts);
  check_limits(rows, verdicts);
  check_formulations(rows, verdicts);
}

}  // namespace tress::experiments::constraint_drift
