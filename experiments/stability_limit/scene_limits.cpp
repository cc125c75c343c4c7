#include "experiments/stability_limit/scene_limits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "contract/input_error.h"
#include "experiments/numerics/step_cost.h"
#include "experiments/problems/scene_files.h"
#include "experiments/problems/strand_models.h"
#include "experiments/stability_limit/limit_row.h"
#include "integrators/catalogue.h"
#include "simulation/run/variants.h"
#include "simulation/run/world.h"

namespace tress {
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

/// Of --quick: those that a user is likely to consider.
constexpr std::array quick_methods{
    "semi_implicit_euler",        "backward_euler", "implicit_midpoint",
    "linearly_implicit_midpoint", "bdf2",           "rk4"};

bool considered(const CommandLine& line, const IntegratorEntry& entry) {
  if (entry.adaptive) return false;  // has no step
  if (!line.integrators.empty()) return wanted(line.integrators, entry.id);
  return !line.quick || std::ranges::find(quick_methods, entry.id) != quick_methods.end();
}

/// The scene's own tangent, and the usual one of the method that solves only once a step.
std::set<std::string> tangents_of(const Scene& scene, std::string_view integrator) {
  if (first_word(*scene.model, "tangent").empty()) return {""};
  std::set<std::string> all{std::string(scene.model_options.word("tangent"))};
  if (integrator == "semi_implicit_euler") {
    all.emplace(usual_tangent(*scene.model));
  }
  return all;
}

/// One step length of one search: stable, broken, or empty when the work is used up.
std::optional<StabilityRun> judge(Scene scene, double dt, double t_end, double& left) {
  if (left <= 0) return {};
  scene.options.step = dt;
  scene.options.max_work = left;
  scene.guard = true;
  World world(scene);
  std::size_t coordinates = 0;
  for (const auto& strand : world.snapshot().strands) coordinates += strand.q.size();
  // Whole steps, a few at a time: a step that shorter ones had to replace is too long.
  const double steps = std::ceil(t_end / dt - 1e-9), parts = std::min(steps, 16.0);
  Status status = Status::ok;
  for (double part = 1; part <= parts && status == Status::ok; ++part) {
    status = world.advance(std::round(steps * part / parts) * dt);
    if (world.stats().rejected > 0) break;
  }
  StabilityRun run;
  run.t = world.time();
  run.stats = world.stats();
  run.failure = world.failure();
  left -= total_work(run.stats, static_cast<int>(coordinates / world.systems()));
  if (const Breach* breach = world.breach()) {
    run.broken = broken_by(*breach);
    run.t = breach->t;
  } else if (status != Status::ok || run.stats.rejected > 0) {
    if (left <= 0) return {};
    run.broken = Broken::no_solution;
  }
  return run;
}

void measure(const Scene& scene, const SceneLimits& how, Row& row) {
  const double t_end = std::min(how.horizon, scene.duration);
  row.set("t_end_s", t_end);
  double left = how.most_work;
  std::map<double, StabilityRun> runs;
  StepLimit limit;
  try {
    limit = find_step_limit(how.search, [&](double dt) -> std::optional<Broken> {
      const auto run = judge(scene, dt, t_end, left);
      if (!run) return {};
      return (runs[dt] = *run).broken;
    });
  } catch (const InputError& refused) {
    row.failed("refused", refused.what());
    return;
  }
  set_limit(limit, how.search, row);
  if (!std::isnan(limit.stable)) {
    const Stats& stats = runs.at(limit.stable).stats;
    row.set("steps", stats.steps).set("newton_iterations", stats.newton_iterations);
    const double cost = step_cost(scene, limit.stable, t_end / limit.stable, how.repeat);
    row.set("cost_per_step_s", cost).set("realtime_factor", limit.stable / cost);
  }
  const auto last = runs.find(limit.unstable);
  fail_without_limit(limit, last == runs.end() ? nullptr : &last->second, row);
}

}  // namespace

std::vector<Case> scene_cases(const CommandLine& line,
                              const std::vector<std::string>& files,
                              const SceneLimits& how) {
  if (!line.models.empty()) {
    throw InputError("a scene says itself which model it has", line.place("models"),
                     "leave it out, or change the scene's [model]");
  }
  if (!line.elements.empty()) {
    throw InputError("a scene says itself how its strands are cut",
                     line.place("elements"),
                     "leave it out, or change the scene's elements");
  }
  std::vector<Case> all;
  std::set<std::string> names;
  for (const std::string& file : files) {
    const Scene scene = thinned(read_scene(file), how.strands);
    if (!names.insert(scene.name).second) {
      throw InputError("two scenes of one name", file, "rename one of them");
    }
    for (const IntegratorEntry& entry : integrators()) {
      if (!considered(line, entry)) continue;
      for (const std::string& tangent : tangents_of(scene, entry.id)) {
        Scene own = scene;
        own.integrator = entry.id;
        if (!tangent.empty()) own.model_options.set("tangent", tangent);
        Row row;
        row.set("scene", scene.name).set("model", scene.model->id);
        row.set("integrator", entry.id).set("tangent", tangent);
        if (most_elements(scene) > 0) row.set("elements", most_elements(scene));
        all.push_back({row, [own, how](Row& of_case, const Deadline&) {
                         measure(own, how, of_case);
                       }});
      }
    }
  }
  return all;
}

}  // namespace tress
