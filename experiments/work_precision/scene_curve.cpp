#include "experiments/work_precision/scene_curve.h"

#include <algorithm>
#include <cmath>

#include "contract/input_error.h"
#include "experiments/numerics/tip_track.h"
#include "simulation/run/timing.h"
#include "simulation/run/tip_paths.h"
#include "simulation/scene_changes/changes.h"
#include "simulation/scene_changes/typical_strands.h"

namespace tress::experiments::work_precision {
namespace {

/// One run: one row per error kind, from the same run.
std::vector<Row> measured(const Curve& work, const Scene& scene, const Row& identity) {
  const TipPaths run = tip_paths(scene, 0);
  const int repeat = run.once_s > long_run_s ? 1 : work.extent.repeat;
  const double wall = median(wall_times(scene, repeat));
  std::vector<Row> rows;
  const auto add = [&](std::string_view kind, const std::optional<TipReference>& side) {
    if (!side) return;
    Row row = identity;
    row.set("error_kind", kind);
    set_counts(run.stats, row);
    const double error = tip_error(run.x, side->tip, work.study->length());
    if (error <= 0.5) {
      set_error(error, side->gap, row);
      if (kind == "time") {
        set_achieved(largest_tip_error(run.x, side->tip, work.study->length()),
                     scene.options, row);
      }
      set_time(wall, work.study->duration(), row);
    } else {
      row.failed("diverged", "error above half the length of the strand");
    }
    rows.push_back(row);
  };
  add("time", work.sides->time);
  add("total", work.sides->total);
  return rows;
}

/// Steps of the run, each at least an evaluation and a solve, as total_work() counts.
double least_work(const Scene& scene) {
  const double steps = scene.duration / scene.options.step;
  return 2 * steps * (static_cast<double>(most_elements(scene)) + 10);
}

/// The scene by the method, with the options of the command line; tolerance 0: by steps.
Scene method_of(const Curve& work, double tolerance) {
  Scene scene = work.cut;
  scene.options.tolerance = tolerance;
  scene = driven(std::move(scene), *work.model, *work.integrator);
  const Formulation formulation = scene.options.formulation;
  scene.options = work.options;
  scene.options.formulation = formulation;
  scene.options.max_work = work.extent.work;
  scene.options.tolerance = tolerance;
  return scene;
}

/// From loose to tight, until enough succeeded or the next one takes too long.
std::vector<Row> by_steps(const Curve& work, Scene scene, const Row& identity) {
  const bool adaptive = work.integrator->adaptive;
  std::vector<Row> rows;
  std::optional<Row> last_failed;
  int done = 0;
  for (int i = 0; done < work.extent.rungs; ++i) {
    scene.options.step = std::pow(2, -i) / rate;
    scene.options.rtol = scene.options.atol = std::pow(10, -2 - i);
    if (adaptive ? i == work.extent.rungs : least_work(scene) > work.extent.work) break;
    Row row = identity;
    set_drive(scene.options, adaptive, row);
    try {
      for (Row& made : measured(work, scene, row)) rows.push_back(std::move(made));
      ++done;
    } catch (const InputError&) {
      throw;
    } catch (const std::runtime_error& error) {
      last_failed = row.failed("solver_error", error.what());
      if (done > 0) break;
    }
  }
  if (last_failed) rows.insert(rows.begin(), *last_failed);
  return rows;
}

/// Strands that touch exchange forces at every fixed step.
bool exchanges(const Scene& scene) {
  const Parameters* const between = scene.interaction();
  return scene.friction() != nullptr || scene.mesh() != nullptr ||
         (between != nullptr && between->word("coupling") != "monolithic");
}

/// As above; a failure is a row of its own, for the next tolerance may do.
void by_tolerances(const Curve& work, const Row& identity, std::vector<Row>& rows) {
  if (exchanges(work.cut)) return;
  for (const double tolerance : work.extent.tolerances) {
    const Scene scene = method_of(work, tolerance);
    Row row = identity;
    row.set("formulation", name(scene.options.formulation));
    set_drive(scene.options, false, row);
    try {
      for (Row& made : measured(work, scene, row)) rows.push_back(std::move(made));
    } catch (const InputError& error) {
      rows.push_back(row.failed("refused", error.what()));
    } catch (const std::runtime_error& error) {
      rows.push_back(row.failed("solver_error", error.what()));
    }
  }
}

}  // namespace

Extent extent(const CommandLine& line, const Settings& settings) {
  Extent made = line.full    ? Extent{1e8, 8, 9, {160, 1 / (64 * rate)}, line.repeat, {}}
                : line.quick ? Extent{1e6, 4, 6, {80, 1 / (32 * rate)}, line.repeat, {}}
                             : Extent{1e7, 6, 8, {160, 1 / (64 * rate)}, line.repeat, {}};
  const double chosen = settings.experiment().number("row_work");
  if (chosen > 0) made.work = chosen;
  made.tolerances = tolerances(line);
  return made;
}

Study::Study(SceneFile file, const Settings& settings)
    : name_(std::move(file.name)), scene_(std::move(file.scene)) {
  const Parameters& p = settings.experiment();
  scene_.duration = std::min(p.number("horizon_s"), scene_.duration);
  scene_.frame_rate = rate;
  const auto most = static_cast<std::size_t>(p.whole("strands"));
  if (!scene_.strands_touch() && scene_.strands.size() > most) {
    chosen_ = typical_strands(scene_.strands, most);
  }
  const Scene used = cut(0);
  for (const Strand& strand : used.strands) length_ += strand.length();
  length_ /= static_cast<double>(used.strands.size());
}

Scene Study::cut(int elements) const {
  Scene made = elements > 0 ? with_elements(scene_, elements) : scene_;
  return chosen_.empty() ? made : only(std::move(made), chosen_);
}

std::vector<Row> curve(const Curve& work, const Row& identity) {
  try {
    const Scene scene = method_of(work, 0);
    Row own = identity;
    own.set("formulation", name(scene.options.formulation));
    std::vector<Row> rows = by_steps(work, scene, own);
    if (work.integrator->error_controlled) by_tolerances(work, own, rows);
    return rows;
  } catch (const InputError& error) {
    Row row = identity;
    return {row.failed("refused", error.what())};
  }
}

}  // namespace tress::experiments::work_precision
