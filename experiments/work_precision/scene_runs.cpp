#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "contract/input_error.h"
#include "experiments/numerics/tip_track.h"
#include "experiments/problems/scene_files.h"
#include "experiments/problems/strand_reference.h"
#include "experiments/run/message.h"
#include "experiments/work_precision/work_precision.h"
#include "integrators/catalogue.h"
#include "simulation/run/timing.h"
#include "simulation/run/tip_paths.h"
#include "simulation/scene/changes.h"
#include "simulation/scene/typical_strands.h"

namespace tress::experiments::work_precision {
namespace {

constexpr double rate = 60;  // 1/s, of the instants at which tips are compared

/// Extent of the sweep.
struct Extent {
  double work;         // per run
  int rungs;           // steps or tolerances of a curve
  int model_halvings;  // of a frame, to the step of a model's reference
  Finest rod;
  int repeat;
};

Extent extent(const CommandLine& line, const Settings& settings) {
  Extent made = line.full    ? Extent{1e8, 8, 9, {160, 1 / (64 * rate)}, line.repeat}
                : line.quick ? Extent{1e6, 4, 6, {80, 1 / (32 * rate)}, line.repeat}
                             : Extent{1e7, 6, 8, {160, 1 / (64 * rate)}, line.repeat};
  const double chosen = settings.experiment().number("row_work");
  if (chosen > 0) made.work = chosen;
  return made;
}

/// A scene file as used by all its runs: typical strands, up to the horizon.
class Study {
 public:
  Study(SceneFile file, const Settings& settings)
      : name_(std::move(file.name)), scene_(std::move(file.scene)) {
    const Parameters& p = settings.experiment();
    scene_.duration = std::min(p.number("horizon_s"), scene_.duration);
    scene_.frame_rate = rate;
    const auto most = static_cast<std::size_t>(p.whole("strands"));
    if (scene_.interaction() == nullptr && scene_.strands.size() > most) {
      chosen_ = typical_strands(scene_.strands, most);
    }
    const Scene used = cut(0);
    for (const Strand& strand : used.strands) length_ += strand.length();
    length_ /= static_cast<double>(used.strands.size());
  }

  const std::string& name() const { return name_; }
  double length() const { return length_; }  // mean, m
  bool touching() const { return scene_.interaction() != nullptr; }
  double duration() const { return scene_.duration; }

  /// Strands with this many elements, 0: the file's discretisation. The choice of strands
  /// does not depend on it.
  Scene cut(int elements) const {
    Scene made = elements > 0 ? with_elements(scene_, elements) : scene_;
    return chosen_.empty() ? made : only(std::move(made), chosen_);
  }

 private:
  std::string name_;
  Scene scene_;
  std::vector<std::size_t> chosen_;
  double length_ = 0;
};

/// References for the errors of one model at one number of elements.
struct Sides {
  std::optional<TipReference> time, total;
};

struct Curve {
  std::shared_ptr<const Study> study;
  Scene cut;
  const ModelEntry* model;
  const IntegratorEntry* integrator;
  std::shared_ptr<const Sides> sides;
  Options options;
  Extent extent;
};

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
    row.set("steps", run.stats.steps).set("rejected", run.stats.rejected);
    const double error = tip_error(run.x, side->tip, work.study->length());
    if (error <= 0.5) {
      set_error(error, side->gap, row);
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

/// The rows of one curve, from loose to tight.
std::vector<Row> curve(const Curve& work, const Row& identity) {
  Scene scene;
  try {
    scene = driven(work.cut, *work.model, *work.integrator);
  } catch (const InputError& error) {
    Row row = identity;
    return {row.failed("refused", error.what())};
  }
  const Formulation formulation = scene.options.formulation;
  scene.options = work.options;
  scene.options.formulation = formulation;
  scene.options.max_work = work.extent.work;
  const bool adaptive = work.integrator->adaptive;
  std::vector<Row> rows;
  std::optional<Row> last_failed;
  int done = 0;
  for (int i = 0; done < work.extent.rungs; ++i) {
    scene.options.step = std::pow(2, -i) / rate;
    scene.options.rtol = scene.options.atol = std::pow(10, -2 - i);
    if (adaptive ? i == work.extent.rungs : least_work(scene) > work.extent.work) break;
    Row row = identity;
    row.set("formulation", name(formulation));
    adaptive ? row.set("rtol", scene.options.rtol) : row.set("dt_s", scene.options.step);
    try {
      for (Row& made : measured(work, scene, row)) rows.push_back(std::move(made));
      ++done;
    } catch (const InputError& error) {
      return {row.failed("refused", error.what())};
    } catch (const std::runtime_error& error) {
      last_failed = row.failed("solver_error", error.what());
      if (done > 0) break;
    }
  }
  if (last_failed) rows.insert(rows.begin(), *last_failed);
  return rows;
}

/// The tips of one reference run, with the reference's steps and elements.
TipsOf tips_of(const Study& study, int given_elements) {
  return [&study, given_elements](std::string_view model, std::string_view integrator,
                                  int elements, const Options& options) {
    const Scene cut = study.cut(given_elements >= 0 ? given_elements : elements);
    Scene scene = driven(cut, find_model(model), find_integrator(integrator));
    scene.options.step = options.step;
    scene.options.newton_tolerance = options.newton_tolerance;
    return tip_paths(scene, 0).x;
  };
}

/// Empty, with `why`, if a reference cannot be computed.
template <class F>
std::optional<TipReference> made(const F& make, std::string& why) {
  try {
    return make();
  } catch (const std::exception& error) {  // refused, or the run failed
    why = error.what();
    return {};
  }
}

/// A row with the reason why there are no others.
Case without(Row identity, std::string_view kind, const std::string& why) {
  identity.set("error_kind", kind);
  return {identity, [why](Row& row, const Deadline&) { row.failed("refused", why); }};
}

/// The rows of one scene file.
class SceneRows {
 public:
  SceneRows(const CommandLine& line, const Settings& settings, SceneFile file)
      : line_(line),
        settings_(settings),
        extent_(extent(line, settings)),
        study_(std::make_shared<const Study>(std::move(file), settings)) {}

  std::vector<Case> cases() {
    std::optional<TipReference> rod;
    if (keeps(settings_, "error", "total") && !line_.dry_run) rod = of_rod();
    const std::vector<int> cuts =
        line_.elements.empty() ? std::vector<int>{0} : line_.elements;
    for (const int elements : cuts) {
      for (const ModelEntry& model : model_catalogue()) {
        if (model.on_strand == nullptr || !wanted(line_.models, model.id)) continue;
        add(model, elements, rod);
      }
    }
    return std::move(all_);
  }

 private:
  std::optional<TipReference> of_rod() {
    Row identity;
    identity.set("scene", study_->name());
    std::string why =
        "strands that touch each other: no two models agree on them for long";
    std::optional<TipReference> rod;
    if (!study_->touching()) {
      tell("{}: continuous rod\n", study_->name());
      rod = made(
          [&] {
            return converged_rod(tips_of(*study_, -1), study_->length(), free_rod,
                                 extent_.rod);
          },
          why);
    }
    if (!rod) all_.push_back(without(identity, "total", why));
    return rod;
  }

  void add(const ModelEntry& model, int elements,
           const std::optional<TipReference>& rod) {
    const Scene cut = study_->cut(elements);
    Row identity;
    identity.set("scene", study_->name()).set("model", model.id);
    identity.set("elements", most_elements(cut));
    auto sides = std::make_shared<Sides>();
    sides->total = rod;
    if (keeps(settings_, "error", "time") && !line_.dry_run) {
      std::string why;
      tell("{}: converged {}\n", study_->name(), model.id);
      const Finest finest{elements, std::pow(2, -extent_.model_halvings) / rate};
      sides->time = made(
          [&] {
            return extrapolated_model(tips_of(*study_, elements), study_->length(),
                                      model.id, finest);
          },
          why);
      if (!sides->time) all_.push_back(without(identity, "time", why));
    }
    if (!sides->time && !sides->total && !line_.dry_run) return;
    for (const IntegratorEntry& entry : integrator_catalogue()) {
      if (!wanted(line_.integrators, entry.id)) continue;
      if (line_.quick && line_.integrators.empty() && entry.adaptive) continue;
      const Curve work{study_, cut, &model, &entry, sides, settings_.options(), extent_};
      Row own = identity;
      own.set("integrator", entry.id);
      all_.push_back({own, {}, [work](const Row& row, const Deadline&) {
                        return curve(work, row);
                      }});
    }
  }

  const CommandLine& line_;
  const Settings& settings_;
  Extent extent_;
  std::shared_ptr<const Study> study_;
  std::vector<Case> all_;
};

}  // namespace

std::vector<Case> scene_runs(const CommandLine& line, const Settings& settings,
                             const std::vector<std::string>& files) {
  std::vector<Case> all;
  for (SceneFile& file : read_strand_scenes(files)) {
    for (Case& one : SceneRows(line, settings, std::move(file)).cases()) {
      all.push_back(std::move(one));
    }
  }
  if (all.empty()) {
    throw InputError("no strand model among them", line.place("models"),
                     "./tress list shows the models");
  }
  return all;
}

}  // namespace tress::experiments::work_precision
