#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "contract/input_error.h"
#include "experiments/numerics/step_cost.h"
#include "experiments/problems/scene_files.h"
#include "experiments/stability_limit/stability_limit.h"
#include "integrators/catalogue.h"
#include "simulation/run/world.h"
#include "simulation/scene_changes/changes.h"

namespace tress::experiments::stability_limit {
namespace {

Broken broken_by(const Breach& breach) {
  switch (breach.kind) {
    case Breach::Kind::not_finite:
      return Broken::not_finite;
    case Breach::Kind::stretch:
      return Broken::stretch;
    case Breach::Kind::speed:
      return Broken::speed;
    case Breach::Kind::energy:
      break;
  }
  return Broken::energy;
}

/// A step is judged over this many times the scene's duration, as far as this number of
/// steps reaches: slow growth is seen late. The limit that is found is judged longer
/// than those that are tried.
constexpr double times_as_long = 5, tried_steps = 2000, confirmed_steps = 50000;

/// Time over which a step is judged: `least` at least.
double judged_s(const Scene& scene, double least, double dt, double most_steps) {
  return std::max(least, std::min(times_as_long * scene.duration, most_steps * dt));
}

/// One step length or tolerance of one search: stable, broken, or empty when the work is
/// used up.
std::optional<StabilityRun> judge(Scene scene, double t_end, double& left) {
  if (left <= 0) return {};
  const bool by_step = scene.options.tolerance == 0;
  const double dt = by_step ? scene.options.step : scene.options.max_step;
  scene.options.max_work = left;
  scene.guard = true;
  World world(scene);
  // Whole steps, a few at a time: a step that had to be replaced by shorter ones is too
  // long.
  const double steps = std::ceil(t_end / dt - 1e-9), parts = std::min(steps, 16.0);
  Status status = Status::ok;
  for (double part = 1; part <= parts && status == Status::ok; ++part) {
    status = world.advance(std::round(steps * part / parts) * dt);
    if (by_step && world.stats().rejected > 0) break;
  }
  StabilityRun run;
  run.t = world.time();
  run.stats = world.stats();
  run.failure = world.failure();
  left -= world.work();
  if (const Breach* breach = world.breach()) {
    run.broken = broken_by(*breach);
    run.t = breach->t;
  } else if (status != Status::ok || (by_step && run.stats.rejected > 0)) {
    if (left <= 0) return {};
    run.broken = Broken::no_solution;
  }
  return run;
}

/// Stability is not monotone, so steps between those of the search are tried as well:
/// these parts of the limit. Where one is unstable, the limit falls below it, and the
/// parts of the new one are tried.
constexpr double parts_of_limit[] = {1,    0.99, 0.97, 0.95, 0.92, 0.9,
                                     0.87, 0.84, 0.8,  0.75, 0.7};
constexpr double after_unstable = 0.9;

/// Runs the parts of the limit that the runs show, first as in the search, then for
/// longer. Returns false if the work of a judge was used up before all parts of a limit
/// had been run as in the search.
bool confirm(const StepSearch& search, const JudgeStep& as_searched,
             const JudgeStep& for_longer, SearchedSteps& searched) {
  double limit = step_limit(searched, search).stable;
  while (limit > 0) {
    double unstable = 0;
    for (const JudgeStep* judge : {&as_searched, &for_longer}) {
      for (const double part : parts_of_limit) {
        const double dt = part * limit;
        if (judge == &as_searched && searched.runs.contains(dt)) continue;
        const auto run = (*judge)(dt);
        if (!run) return judge == &for_longer;
        searched.runs[dt] = *run;
        if (!run->stable()) unstable = dt;
        if (unstable > 0) break;
      }
      if (unstable > 0) break;
    }
    if (unstable == 0) return true;
    const double below = step_limit(searched, search).stable;
    limit = below > after_unstable * unstable ? below : after_unstable * unstable;
  }
  return false;
}

/// Longer steps than this part of the longest run are not tried: fewer of them would show
/// no growth.
constexpr double least_steps = 10;

void inconclusive(double stable, Row& row) {
  row.set("dt_max_s", std::numeric_limits<double>::quiet_NaN());
  row.failed("inconclusive",
             stable > 0
                 ? fmt::format("the work of a row was used up before the steps just "
                               "below {:.3g} s, which was stable, had been tried",
                               stable)
                 : "the work of a row was used up by the longest step");
}

void measure(const Scene& scene, const SceneLimits& how, Row& row) {
  const double t_end = std::min(how.horizon, scene.duration);
  row.set("t_end_s", t_end);
  const StepSearch search =
      up_to(times_as_long * scene.duration / least_steps, how.search);
  Scene tried = scene;
  tried.options.tolerance = 0;
  const auto confirmed_s = [&](double dt) {
    return judged_s(scene, t_end, dt, confirmed_steps);
  };
  const auto judge_to = [&](double dt, double end, double& work) {
    tried.options.step = dt;
    return judge(tried, end, work);
  };
  double left = how.most_work, left_checking = how.most_work,
         left_confirming = how.most_work, left_above = how.most_work;
  const auto as_searched = [&](double& work) {
    return [&](double dt) {
      return judge_to(dt, judged_s(scene, t_end, dt, tried_steps), work);
    };
  };
  std::optional<FoundLimit> limit;
  try {
    tried = driven(std::move(tried), *scene.model, find_integrator(scene.integrator));
    SearchedSteps searched = search_steps(search, as_searched(left));
    const bool checked = confirm(
        search, as_searched(left_checking),
        [&](double dt) { return judge_to(dt, confirmed_s(dt), left_confirming); },
        searched);
    limit = found_limit(searched, search, row);
    if (limit ? !checked : searched.runs.empty()) {
      return inconclusive(limit ? limit->step : 0, row);
    }
    if (!limit) return;
    // Without work left to confirm it, the limit is judged for as long as in the search.
    row.set("t_end_s", std::min(confirmed_s(limit->step), limit->run.t));
    if (row.text("limited_by") != "cap") {
      constexpr double above = 1.5;
      const double dt = above * limit->step;
      if (const auto far = judge_to(dt, confirmed_s(dt), left_above)) {
        row.set("at_1_5", far->stable() ? "stable" : name(far->broken));
      }
    }
  } catch (const InputError& refused) {
    row.failed("refused", refused.what());
  }
  if (limit) {
    set_cost(*limit, step_cost(tried, limit->step, t_end / limit->step, how.repeat), row);
  }
}

void measure_tolerances(const Scene& scene, const SceneLimits& how, Row& row) {
  row.set("t_end_s", scene.duration);
  double left = how.most_work;
  Scene tried = scene;
  tried.options.max_step = how.search.coarsest;
  try {
    find_tolerances(
        [&](double tolerance) -> std::optional<ToleranceRun> {
          const double before = left;
          tried.options.tolerance = tolerance;
          const auto run =
              judge(driven(tried, *tried.model, find_integrator(tried.integrator)),
                    scene.duration, left);
          if (!run) return {};
          return ToleranceRun{*run, before - left};
        },
        row);
    if (row.status() == "gave_up") {
      row.failed("inconclusive", std::string(row.text("reason")));
    }
  } catch (const InputError& refused) {
    row.failed("refused", refused.what());
  }
}

/// A row for each method that `chosen` includes.
template <typename Chosen>
std::vector<Case> cases_of(const CommandLine& line, const std::vector<std::string>& files,
                           const SceneLimits& how, std::string_view study, Chosen chosen,
                           void (*fill)(const Scene&, const SceneLimits&, Row&)) {
  leave_strands_to_the_scene(line);
  std::vector<Case> all;
  for (const Scene& given : read_scenes(files)) {
    const Scene scene = thinned(given, how.strands);
    for (const IntegratorEntry& entry : integrator_catalogue()) {
      if (!chosen(line, entry)) continue;
      for (const std::string_view jacobian : scene_jacobians(scene, entry.id)) {
        Scene own = scene;
        own.integrator = entry.id;
        if (!jacobian.empty()) own.model_options.set("jacobian", jacobian);
        Row row;
        row.set("study", study).set("scene", scene.name);
        row.set("model", scene.model->id);
        row.set("integrator", entry.id).set("jacobian", jacobian);
        if (most_elements(scene) > 0) row.set("elements", most_elements(scene));
        all.push_back({row, [own, how, fill](Row& of_case, const Deadline&) {
                         fill(own, how, of_case);
                       }});
      }
    }
  }
  return all;
}

}  // namespace

std::vector<Case> scene_cases(const CommandLine& line,
                              const std::vector<std::string>& files,
                              const SceneLimits& how) {
  return cases_of(line, files, how, "file", considered, measure);
}

std::vector<Case> scene_tolerance_cases(const CommandLine& line,
                                        const std::vector<std::string>& files,
                                        const SceneLimits& how) {
  return cases_of(line, files, how, "tolerance", by_tolerance, measure_tolerances);
}

}  // namespace tress::experiments::stability_limit
