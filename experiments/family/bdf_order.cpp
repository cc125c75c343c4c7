// Which BDF order suits a rod of 20 elements, compared with ESDIRK, at equal errors.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "experiments/family/family.h"
#include "experiments/numerics/tip_track.h"

namespace tress::experiments::family {
namespace {

constexpr Claim claims[] = {
    {"bdf_order2_at_1e-2",
     "BDF needs no more work with order 2 than with order 5, for a tip error of 1e-2",
     "work of order 5 over that of order 2 at a tip error of 1e-2"},
    {"bdf_order2_at_1e-3",
     "BDF needs no more work with order 2 than with order 5, for a tip error of 1e-3",
     "work of order 5 over that of order 2 at a tip error of 1e-3"},
    {"bdf_order2_at_1e-4",
     "BDF needs no more work with order 2 than with order 5, for a tip error of 1e-4",
     "work of order 5 over that of order 2 at a tip error of 1e-4"},
    {"esdirk_steps_at_1e-3",
     "ESDIRK takes no more steps than BDF, for a tip error of 1e-3",
     "steps of the BDF with fewer over those of ESDIRK at a tip error of 1e-3"},
    {"esdirk_work_at_1e-3", "ESDIRK needs no more work than BDF, for a tip error of 1e-3",
     "work of the cheaper BDF over that of ESDIRK at a tip error of 1e-3"}};

constexpr double t_end = 0.2;  // s
constexpr int samples = 12, elements = 20;
constexpr std::array targets{1e-2, 1e-3, 1e-4};  // of the tip, over the length
constexpr std::array tolerances{1e-2, 1e-3, 1e-4, 1e-5, 1e-6};
constexpr double reference_tolerance = 1e-8;
constexpr long most_steps = 4000;  // per run; ten times as many for the reference

struct Method {
  std::string_view integrator;
  int order;
};
constexpr std::array methods{Method{"cvode_bdf", 2}, Method{"cvode_bdf", 5},
                             Method{"arkode_dirk", 0}};

constexpr double never = std::numeric_limits<double>::infinity();

TipRun run_at(const Rod& rod, const Method& method, double rtol, long most) {
  const auto system = make_system(straightened(rod), "super_helix", elements, "bend");
  Options options;
  options.rtol = options.atol = rtol;
  options.max_order = method.order;
  options.max_steps = most;
  return run_tip(method.integrator, *system, options, t_end, samples);
}

/// Calls of the model: all cost about the same.
double work_of(const Stats& stats) {
  return static_cast<double>(stats.residuals + stats.linearizations + stats.solves);
}

/// Work of the cheapest run that meets an error; infinite if none does.
struct Cost {
  double steps = never, work = never;
};

using Costs = std::array<Cost, targets.size()>;

Costs costs_of(const Rod& rod, const Method& method, In reference) {
  Costs least;
  for (const double rtol : tolerances) {
    const TipRun run = run_at(rod, method, rtol, most_steps);
    if (run.status != Status::ok) continue;
    const double error = tip_error(run.tip, reference, rod.length);
    for (std::size_t i = 0; i < targets.size(); ++i) {
      if (error > targets[i] || work_of(run.stats) >= least[i].work) continue;
      least[i] = {static_cast<double>(run.stats.steps), work_of(run.stats)};
    }
  }
  return least;
}

Row compared(Row row, const Claim& claim, double work, double other) {
  if (!std::isfinite(work) && !std::isfinite(other)) {
    return no_answer(row, claim, "not_met", "neither met the error in 4000 steps");
  }
  // A method that never meets the target is more expensive by the step limit.
  constexpr double most = 100;
  const double ratio = std::clamp(other / work, 1 / most, most);
  return answer(row.set("elements", elements), claim, ratio, other >= work);
}

std::vector<Row> run(const Rod& rod, const Row& row) {
  const TipRun fine = run_at(rod, methods[2], reference_tolerance, 10 * most_steps);
  const TipRun other = run_at(rod, methods[1], reference_tolerance, 10 * most_steps);
  const double gap = tip_error(other.tip, fine.tip, rod.length);
  std::vector<Row> rows;
  if (!(gap < targets.back() / 3)) {
    for (const Claim& claim : claims) {
      rows.push_back(no_answer(row, claim, "no_reference",
                               "ESDIRK and BDF at 1e-8 do not agree to 3e-5"));
    }
    return rows;
  }
  const Costs two = costs_of(rod, methods[0], fine.tip);
  const Costs five = costs_of(rod, methods[1], fine.tip);
  const Costs esdirk = costs_of(rod, methods[2], fine.tip);
  const Row with = Row(row).set("gap", gap);
  for (std::size_t i = 0; i < targets.size(); ++i) {
    rows.push_back(compared(with, claims[i], two[i].work, five[i].work));
  }
  rows.push_back(
      compared(with, claims[3], esdirk[1].steps, std::min(two[1].steps, five[1].steps)));
  rows.push_back(
      compared(with, claims[4], esdirk[1].work, std::min(two[1].work, five[1].work)));
  return rows;
}

}  // namespace

const Study bdf_order{"bdf_order", claims, run};

}  // namespace tress::experiments::family
