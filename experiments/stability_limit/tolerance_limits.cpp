#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "experiments/problems/formulations.h"
#include "experiments/problems/strand_models.h"
#include "experiments/stability_limit/stability_limit.h"

namespace tress::experiments::stability_limit {
namespace {

constexpr double ladder[] = {1e-1, 1e-2, 1e-3, 1e-4, 1e-5};
constexpr double usual_tolerance = 1e-3;
// On every model; super_helix has every scene.
constexpr std::string_view scenes_of_all[] = {"release", "shake"};
constexpr std::string_view with_every_scene = "super_helix";

struct Work {
  StabilityCase which;
  Parameters parameters;
  Options options;
  double most_work;
};

void measure(const Work& work, Row& row) {
  const StabilityCase& c = work.which;
  const auto system = c.model->make(work.parameters);
  const StabilityBounds bounds = stability_bounds(*c.scene, work.parameters, *system);
  const State start = perturbed_start(*system);
  row.set("t_end_s", c.scene->t_end);
  row.set("energy_bound_j", bounds.energy).set("speed_bound_m_s", bounds.speed);
  Options options = work.options;
  double left = work.most_work;
  find_tolerances(
      [&](double tolerance) -> std::optional<ToleranceRun> {
        if (left <= 0) return {};
        options.tolerance = tolerance;
        options.max_work = left;
        options.formulation =
            preferred_formulation(find_integrator(c.integrator), *system, tolerance)
                .value();
        const auto run =
            judge_run(c.integrator, *system, options, start, c.scene->t_end, bounds);
        if (!run) return {};
        const double done = total_work(run->stats, system->layout().coordinates);
        left -= done;
        return ToleranceRun{*run, done};
      },
      row);
}

/// By the linear-time solver where there is a choice, and the exact Jacobian.
StabilityCase case_of(const StrandScene& scene, const ModelEntry& model,
                      std::string_view integrator, std::string_view modes, int elements) {
  return {&scene,
          &model,
          integrator,
          first_word(model, "solver"),
          first_word(model, "jacobian"),
          modes,
          elements,
          undamped};
}

bool usual(const StrandScene& scene, const ModelEntry& model) {
  return model.id == with_every_scene ||
         std::ranges::find(scenes_of_all, scene.name) != std::end(scenes_of_all);
}

}  // namespace

void find_tolerances(
    const std::function<std::optional<ToleranceRun>(double tolerance)>& judge, Row& row) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  double loosest = none, tightest = none;
  std::optional<StabilityRun> unstable;
  int runs = 0;
  for (const double tolerance : ladder) {
    const auto tried = judge(tolerance);
    if (!tried) break;
    ++runs;
    if (!tried->run.stable()) {
      unstable = tried->run;
      loosest = none;
      continue;
    }
    if (std::isnan(loosest)) loosest = tolerance;
    tightest = tolerance;
    if (tolerance != usual_tolerance) continue;
    row.set("steps_usual", tried->run.stats.steps).set("work_usual", tried->work);
  }
  row.set("tolerance_loosest", loosest).set("tolerance_tightest", tightest);
  row.set("runs", runs).set("search_done", runs == std::ssize(ladder));
  if (unstable) {
    row.set("limited_by", name(unstable->broken));
  } else if (runs > 0) {
    row.set("limited_by", "cap");
  }
  if (!std::isnan(loosest)) return;
  if (unstable) {
    row.failed("unstable", "at the tightest tolerance that was tried: " +
                               std::string(name(unstable->broken)) + " " +
                               unstable->failure);
  } else {
    row.failed("gave_up", "the work of a row was used up by the loosest tolerance");
  }
}

bool by_tolerance(const CommandLine& line, const IntegratorEntry& entry) {
  if (!entry.error_controlled) return false;
  if (!line.integrators.empty()) return wanted(line.integrators, entry.id);
  return !line.quick || entry.id == "tr_bdf2";
}

std::vector<Case> tolerance_cases(const CommandLine& line, const Settings& settings,
                                  double most_work) {
  const Parameters& rows = settings.experiment();
  std::vector<Case> all;
  const std::string_view study = rows.word("study");
  if (study != "all" && study != "tolerance") return all;
  const std::vector<int> counts =
      line.elements.empty() ? std::vector<int>{usual_elements} : line.elements;
  for (const StrandScene& scene : strand_scenes()) {
    for (const ModelEntry* model : strand_models()) {
      for (const IntegratorEntry& entry : integrator_catalogue()) {
        if (!by_tolerance(line, entry)) continue;
        for (const int elements : counts) {
          const StabilityCase c =
              case_of(scene, *model, entry.id, rows.word("modes"), elements);
          if (!c.selected(line, rows) || !(line.full || usual(scene, *model))) continue;
          if (!possible(c, settings)) continue;
          Work work{c, c.parameters(settings), settings.options(), most_work};
          work.options.max_step = std::min(rows.number("cap_s"), scene.coarsest);
          Row row = c.identity();
          row.set("study", "tolerance");
          all.push_back(
              {row, [work](Row& of_case, const Deadline&) { measure(work, of_case); }});
        }
      }
    }
  }
  return all;
}

}  // namespace tress::experiments::stability_limit
