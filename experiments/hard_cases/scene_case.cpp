#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "contract/input_error.h"
#include "experiments/hard_cases/hard_cases.h"
#include "experiments/problems/scene_files.h"
#include "simulation/files/parse.h"
#include "simulation/run/timing.h"
#include "simulation/scene_changes/changes.h"

namespace tress::experiments::hard_cases {
namespace {

/// The Jacobians to try.
std::vector<std::string_view> jacobians(const CommandLine& line, const Scene& scene,
                                        const ModelEntry& model,
                                        std::string_view integrator) {
  if (&model != scene.model) return tried_jacobians(line, model, integrator);
  const std::set<std::string_view> all = scene_jacobians(scene, integrator);
  return {all.begin(), all.end()};
}

Scene with_model(const Scene& scene, const ModelEntry& model, std::string_view jacobian) {
  Scene changed = scene;
  if (&model != scene.model)
    changed = with_method(std::move(changed), {&model, {}, {}, {}});
  if (!jacobian.empty()) changed.model_options.set("jacobian", jacobian);
  return changed;
}

struct Work {
  Scene scene;
  Pace pace;
  SceneCriteria criteria;
  double horizon;  // s; 0: the scene's duration
  WorkLimit limit;
};

void measure(const Work& work, Row& row) {
  SceneSurvival s;
  try {
    const Scene scene =
        driven(work.scene, *work.scene.model, find_integrator(work.scene.integrator));
    const double t_end =
        work.horizon > 0 ? std::min(work.horizon, scene.duration) : scene.duration;
    s = survive(scene, work.pace, work.criteria, t_end, work.limit);
    row.set("measure_name", s.measured).set("limit", s.limit);
    row.set("criterion", s.criterion);
  } catch (const InputError& refused) {
    s.why = refused.what();
  }
  set_survival(s, row);
}

Pace pace_of(const Scene& scene) {
  const Options& own = scene.options;
  if (own.tolerance == 0) return {own.step};
  return {own.max_step > 0 ? own.max_step : longest_step, own.tolerance};
}

/// Returns the standard paces and the scene's own, where the integrator supports it.
std::set<Pace> paces_of(const CommandLine& line, const Parameters& own,
                        const Scene& scene, std::string_view integrator) {
  std::set<Pace> all;
  for (const Pace& pace : tried_paces(line, integrator)) all.insert(pace);
  const Pace of_scene = pace_of(scene);
  if (of_scene.tolerance == 0 || find_integrator(integrator).error_controlled) {
    all.insert(of_scene);
  }
  std::erase_if(all, [&](const Pace& pace) { return !selected(own, pace); });
  return all;
}

std::vector<const ModelEntry*> models_of(const CommandLine& line, const Scene& scene) {
  std::vector<const ModelEntry*> all;
  for (const ModelEntry& model : model_catalogue()) {
    const bool able =
        scene.strands.empty() ? &model == scene.model : model.on_strand != nullptr;
    if (able && wanted(line.models, model.id)) all.push_back(&model);
  }
  return all;
}

double row_work(const CommandLine& line, const Parameters& own) {
  if (own.number("row_work") > 0) return own.number("row_work");
  return line.quick ? 4e6 : line.full ? 1e8 : 2e7;
}

}  // namespace

SceneSurvival survive(const Scene& given, const Pace& pace, const SceneCriteria& criteria,
                      double t_end, const WorkLimit& limit) {
  Scene scene = given;
  scene.guard = true;
  scene.options = pace.applied(scene.options);
  // Counted here, over all strands; but between two looks a method with a tolerance may
  // take any number of steps.
  const bool by_tolerance = pace.tolerance > 0;
  scene.options.max_work = by_tolerance && std::isfinite(limit.most) ? limit.most : 0;
  const double dt = pace.step;
  World world(scene);
  SceneGauge gauge(scene, world, criteria);
  SceneSurvival result;
  result.outcome = Outcome::stable;
  const auto ends = [&result](Outcome outcome, std::string why) {
    result.outcome = outcome;
    result.why = std::move(why);
  };
  const SceneGauge::Criterion* broken = nullptr;
  const auto steps = static_cast<long>(std::max(1.0, std::ceil(t_end / dt - 1e-9)));
  result.wall_s = seconds_of([&] {
    for (long k = 1; k <= steps && passed(result.outcome); ++k) {
      const Status status = world.advance(static_cast<double>(k) * dt);
      if (const Breach* breach = world.breach()) {
        ends(Outcome::unstable, breach->message());
      } else if (status != Status::ok) {
        if (by_tolerance && world.work() >= limit.most) {
          ends(Outcome::not_finished, cut_at(world.time()));
        } else {
          ends(Outcome::unstable, world.failure());
        }
      } else if (!by_tolerance && world.stats().rejected > 0) {
        ends(Outcome::unstable,
             fmt::format("no solution for the step to t = {:.9g} s, only for shorter "
                         "ones in its place",
                         world.time()));
      } else if (broken = gauge.broken(); broken != nullptr) {
        ends(Outcome::unstable,
             fmt::format("{} = {:.3g} > {:.3g} at t = {:.9g} s, {}", broken->name,
                         broken->largest, broken->limit, world.time(), broken->where()));
      } else if (k < steps && world.work() > limit.most) {
        ends(Outcome::not_finished, cut_at(world.time()));
      }
    }
  });
  if (result.outcome == Outcome::unstable && broken == nullptr) {
    result.criterion =
        "every step has a solution, and the guard of simulations finds nothing";
  } else {
    const SceneGauge::Criterion& told = broken != nullptr ? *broken : gauge.nearest();
    result.measured = told.name;
    result.measure = told.largest;
    result.limit = told.limit;
    result.criterion = told.words;
  }
  result.t = world.breach() != nullptr ? world.breach()->t : world.time();
  result.stats = world.stats();
  const Formulation formulation = scene.options.formulation;
  if (formulation != Formulation::parametric) result.formulation = name(formulation);
  if (passed(result.outcome)) result.why = "a scene has nothing to be compared with";
  return result;
}

std::vector<Case> scene_cells(const CommandLine& line, const Settings& settings) {
  settings.leave_models_to_the_scene();
  if (settings.chosen("case")) {
    throw InputError("the scene is the case", line.place("set:case"), "leave it out");
  }
  const Parameters& own = settings.experiment();
  const SceneCriteria criteria{own.number("most_stretch"), own.number("most_depth_m"),
                               own.number("most_energy_gain_j")};
  const auto strands = static_cast<std::size_t>(own.whole("strands"));
  std::vector<Case> all;
  for (const Scene& given : read_scenes(listed_files(own.word("scenes"), "scenes"))) {
    const Scene scene = thinned(given, strands);
    for (const ModelEntry* model : models_of(line, scene)) {
      for (const std::string_view integrator : tried_integrators(line)) {
        for (const std::string_view jacobian :
             jacobians(line, scene, *model, integrator)) {
          for (const Pace& pace : paces_of(line, own, scene, integrator)) {
            Work work{with_model(scene, *model, jacobian),
                      pace,
                      criteria,
                      own.number("horizon_s"),
                      {row_work(line, own)}};
            work.scene.integrator = integrator;
            work.scene.options = pace.applied(settings.options(scene.options));
            Row row;
            row.set("case", scene.name).set("model", model->id);
            row.set("variant",
                    jacobian.empty() ? "" : fmt::format("jacobian={}", jacobian));
            row.set("integrator", integrator);
            pace.identify(row);
            all.push_back(
                {row, [work](Row& of_case, const Deadline&) { measure(work, of_case); }});
          }
        }
      }
    }
  }
  return all;
}

}  // namespace tress::experiments::hard_cases
