// Does a tighter tolerance give a smaller error? Error over tolerance at 1e-2 to 1e-5,
// beside that at ten times the tolerance.
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include "experiments/family/family.h"
#include "experiments/numerics/tip_track.h"
#include "simulation/run/dissipation_warning.h"

namespace tress::experiments::family {
namespace {

constexpr std::string_view statement =
    "with a tenth of the tolerance, the error over the tolerance is at most three times "
    "as large, or the run warns";
constexpr std::string_view value_is =
    "error over the tolerance, over that at ten times the tolerance where that is more "
    "than 1";
constexpr Claim claims[] = {{"tighter_at_1e-3", statement, value_is},
                            {"tighter_at_1e-4", statement, value_is},
                            {"tighter_at_1e-5", statement, value_is}};

constexpr std::string_view models[] = {"super_helix", "articulated_chain", "der"};
constexpr std::array by_tolerance{"tr_bdf2", "esdirk43"};
constexpr double tolerances[] = {1e-2, 1e-3, 1e-4, 1e-5};
static_assert(std::size(tolerances) == std::size(claims) + 1);

constexpr double t_end = 0.4;  // s
constexpr int samples = 24;
// The error of tr_bdf2 falls as the tolerance to the power 5/6, hence a factor of 1.5,
// and the errors of steps add up differently in each run.
constexpr double most_growth = 3;
// References of two tolerances, the tighter of which is the reference: they must agree
// within the tightest tolerance of a run.
constexpr std::string_view reference_method = "esdirk43";
constexpr double reference_tolerance = 1e-7, second_tolerance = 1e-6;
constexpr double reference_calls = 5;  // times those of a run

struct Outcome {
  double error = std::numeric_limits<double>::infinity();  // over the length
  bool warned = false;
  std::string failure = {};
};

/// What a run of this rod and model takes.
struct Subject {
  const Rod& rod;
  std::string_view model;
  double most_calls;
  int elements = elements_of(rod);

  TipRun run(std::string_view integrator, double tolerance, double calls,
             bool* warned = nullptr) const {
    const auto system = make_system(rod, model, elements);
    Guard guard = make_guard(rod, model, elements, *system);
    Options options;
    options.tolerance = tolerance;
    options.max_work = calls * (system->layout().coordinates + 10);
    TipRun found = run_tip(integrator, *system, options, t_end, samples, 0, &guard);
    if (warned != nullptr) *warned = simulation::warns(guard.dissipation());
    return found;
  }
  Outcome outcome(std::string_view integrator, double tolerance, In reference) const {
    Outcome found;
    const TipRun made = run(integrator, tolerance, most_calls, &found.warned);
    found.failure = made.failure;
    if (made.status == Status::ok) {
      found.error = tip_error(made.tip, reference, rod.length);
    }
    return found;
  }
};

Row compared(Row row, std::size_t at, const Outcome& before, const Outcome& now) {
  const double looser = tolerances[at], asked = tolerances[at + 1];
  row.set("position_tol_rel", asked).set("warned", now.warned);
  if (!now.failure.empty()) row.set("failure", now.failure);
  if (!std::isfinite(before.error) || !std::isfinite(now.error)) {
    return no_answer(row, claims[at], "not_met", "a run has no solution");
  }
  const double ratio = now.error / asked / std::max(1.0, before.error / looser);
  row.set("error_rel", now.error).set("looser_error_rel", before.error);
  return answer(row, claims[at], ratio, ratio <= most_growth || now.warned);
}

std::vector<Row> run(const Rod& rod, const Row& row) {
  const Subject subject{rod, row.text("model"), row.number("most_calls")};
  Row with = Row(row).set("elements", subject.elements);
  const double calls = reference_calls * subject.most_calls;
  const TipRun reference = subject.run(reference_method, reference_tolerance, calls);
  const TipRun second = subject.run(reference_method, second_tolerance, calls);
  const double gap = tip_error(second.tip, reference.tip, rod.length);
  const bool known = reference.status == Status::ok && gap <= std::end(tolerances)[-1];
  if (known) with.set("gap", gap);
  std::vector<Row> rows;
  for (const std::string_view integrator : by_tolerance) {
    const Row of_method = Row(with).set("integrator", integrator);
    Outcome before;
    if (known) before = subject.outcome(integrator, tolerances[0], reference.tip);
    for (std::size_t i = 0; i < std::size(claims); ++i) {
      if (!known) {
        rows.push_back(no_answer(
            Row(of_method).set("position_tol_rel", tolerances[i + 1]), claims[i],
            "no_reference", "esdirk43 at 1e-6 and 1e-7 do not agree within 1e-5"));
        continue;
      }
      const Outcome now = subject.outcome(integrator, tolerances[i + 1], reference.tip);
      rows.push_back(compared(of_method, i, before, now));
      before = now;
    }
  }
  return rows;
}

}  // namespace

const Study tolerances_study{"tolerances", claims, run, models, {16, 1}, true};

}  // namespace tress::experiments::family
