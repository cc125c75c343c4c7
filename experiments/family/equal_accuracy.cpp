// Cost of reduced and maximal coordinates at a tip error of 1 %, rod by rod, each
// against the limit of its own equations: the gap is the distance of the two limits.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "experiments/family/family.h"
#include "experiments/numerics/cheapest_run.h"
#include "experiments/problems/strand_reference.h"
#include "simulation/run/timing.h"

namespace tress::experiments::family {
namespace {

constexpr Claim claims[] = {
    {"reduced_cheaper", "super_helix needs less time for 1 % than der",
     "time of der over time of super_helix at a tip error of 1 %"}};

constexpr double t_end = 0.2;  // s
constexpr int samples = 12;
constexpr double target = 0.01;
constexpr std::array ladder{5, 10, 20, 40, 80};
constexpr double coarsest = 1 / 60.0, finest = 1 / 480.0;  // s
constexpr std::string_view integrator = "bdf2";            // solves most of these
constexpr int pairs = 5;  // timed runs, one of each model in turn
constexpr int least_finest_elements = 60;
constexpr double finest_step = 1 / 960.0;  // s

Options options_at(System& system, double dt) {
  Options options;
  options.step = dt;
  options.max_work = enough_work(system, t_end, dt);
  options.newton_tolerance = 1e-5;  // of the typical size
  return options;
}

TipRun run_of(const Rod& rod, std::string_view model, int elements, double dt) {
  const auto system = make_system(rod, model, elements);
  return run_tip(integrator, *system, options_at(*system, dt), t_end, samples);
}

TipRun watched_run_of(const Rod& rod, std::string_view model, int elements, double dt,
                      double most_work) {
  const auto system = make_system(rod, model, elements);
  Guard guard = make_guard(rod, model, elements, *system);
  Options options = options_at(*system, dt);
  options.max_work = std::min(options.max_work, most_work);
  return run_tip(integrator, *system, options, t_end, samples, 0, &guard);
}

std::optional<CheapRun> cheapest(const Rod& rod, std::string_view model, In limit) {
  return cheapest_run(
             {target, ladder, coarsest, finest},
             [&](int elements, double dt, double most_work) -> CheapRun {
               const TipRun run = watched_run_of(rod, model, elements, dt, most_work);
               const double error = run.status == Status::ok
                                        ? tip_error(run.tip, limit, rod.length)
                                        : std::numeric_limits<double>::infinity();
               return {elements, dt, error, total_work(run.stats, run.unknowns)};
             })
      .run;
}

/// Both models in turn, so that load on the machine affects both; the median ratio.
double time_ratio(const Rod& rod, const CheapRun& reduced, const CheapRun& maximal) {
  std::vector<double> ratios;
  for (int i = 0; i < pairs; ++i) {
    const double one = seconds_of(
        [&] { (void)run_of(rod, "super_helix", reduced.elements, reduced.dt); });
    const double other =
        seconds_of([&] { (void)run_of(rod, "der", maximal.elements, maximal.dt); });
    ratios.push_back(other / one);
  }
  return median(ratios);
}

/// The model's limit: two numbers of elements at two steps each, extrapolated at order 2
/// in both. Empty if one of the runs fails.
std::optional<std::vector<double>> limit_of(const Rod& rod, std::string_view model) {
  const int finest_elements =
      std::max(least_finest_elements, 2 * static_cast<int>(std::ceil(rod.winding())));
  std::vector<std::vector<double>> of_steps;
  for (const int elements : {finest_elements / 2, finest_elements}) {
    const TipRun coarse = run_of(rod, model, elements, 2 * finest_step);
    if (coarse.status != Status::ok) return {};
    const TipRun fine = run_of(rod, model, elements, finest_step);
    if (fine.status != Status::ok) return {};
    of_steps.push_back(extrapolated(coarse.tip, fine.tip, 2));
  }
  return extrapolated(of_steps[0], of_steps[1], 2);
}

/// The cheapest run to the model's own limit; empty if there is none.
std::optional<CheapRun> way_of(const Rod& rod, std::string_view model,
                               const std::optional<std::vector<double>>& limit) {
  return limit ? cheapest(rod, model, *limit) : std::nullopt;
}

std::vector<Row> run(const Rod& rod, const Row& row) {
  const Claim& claim = claims[0];
  const auto reduced_limit = limit_of(rod, "super_helix");
  const auto maximal_limit = limit_of(rod, "der");
  const auto reduced = way_of(rod, "super_helix", reduced_limit);
  const auto maximal = way_of(rod, "der", maximal_limit);
  Row with = row;
  if (reduced_limit && maximal_limit) {
    with.set("gap", tip_error(*reduced_limit, *maximal_limit, rod.length));
  }
  if (reduced) with.set("reduced", reduced->elements);
  if (maximal) with.set("maximal", maximal->elements);
  if (!reduced && !maximal) {
    return {no_answer(with, claim, "not_met", "neither comes within 1 % on this ladder")};
  }
  // A model that never meets the target is dearer than any that does.
  constexpr double most = 100;
  if (!maximal) return {answer(with, claim, most, true)};
  if (!reduced) return {answer(with, claim, 1 / most, false)};
  const double ratio = time_ratio(rod, *reduced, *maximal);
  return {answer(with, claim, ratio, ratio > 1)};
}

}  // namespace

const Study equal_accuracy{"equal_accuracy", claims, run};

}  // namespace tress::experiments::family
