// Effect of omitting twist, for the straightened and the original rod.
#include <cmath>
#include <optional>

#include "experiments/family/family.h"
#include "experiments/numerics/tip_track.h"

namespace tress::experiments::family {
namespace {

constexpr Claim claims[] = {
    {"twist_straight_negligible",
     "leaving twist out moves the tip of the straightened rod by less than 1 %",
     "root mean square change of the tip over the length, straightened rod"},
    {"twist_curly_matters", "leaving twist out moves the tip of the rod by over 1 %",
     "root mean square change of the tip over the length, the rod as it is"}};

constexpr double t_end = 0.4;  // s
constexpr int samples = 24;
constexpr double bar = 0.01;
constexpr double coarsest = 2e-3;  // s
constexpr int halvings = 4;        // of a step without a solution

std::optional<std::vector<double>> tip(const Rod& rod, std::string_view modes,
                                       double dt) {
  const auto system = make_system(rod, "super_helix", elements_of(rod), modes);
  Options options;
  options.step = dt;
  options.newton_tolerance = 1e-6;  // of the typical size
  options.max_work = enough_work(*system, t_end, dt);
  TipRun run = run_tip("bdf2", *system, options, t_end, samples);
  if (run.status != Status::ok) return {};
  return std::move(run.tip);
}

/// The change by omitting twist, and the change at half the step without twist.
struct Change {
  double value, gap;
};

std::optional<Change> change_of(const Rod& rod) {
  double dt = coarsest;
  for (int i = 0; i <= halvings; ++i, dt /= 2) {
    const auto whole = tip(rod, "bend_twist", dt);
    if (!whole) continue;
    const auto part = tip(rod, "bend", dt), finer = tip(rod, "bend", dt / 2);
    if (!part || !finer) continue;
    return Change{tip_error(*part, *whole, rod.length),
                  tip_error(*part, *finer, rod.length)};
  }
  return {};
}

Row judged(const Rod& rod, Row row, const Claim& claim, bool over) {
  const auto change = change_of(rod);
  if (!change)
    return no_answer(row, claim, "solver_error", "no solution down to 0.125 ms");
  row.set("elements", elements_of(rod)).set("gap", change->gap);
  // Halving the step must not carry the value across the bar.
  if (std::abs(change->value - bar) <= change->gap) {
    return no_answer(row.set("value", change->value), claim, "unresolved",
                     "half the step changes the run by more than the distance to 1 %");
  }
  return answer(row, claim, change->value, (change->value > bar) == over);
}

std::vector<Row> run(const Rod& rod, const Row& row) {
  return {judged(straightened(rod), row, claims[0], false),
          judged(rod, row, claims[1], true)};
}

}  // namespace

const Study twist{"twist", claims, run};

}  // namespace tress::experiments::family
