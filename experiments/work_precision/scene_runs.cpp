#include <cmath>
#include <memory>
#include <optional>

#include "contract/input_error.h"
#include "experiments/run/message.h"
#include "experiments/work_precision/scene_curve.h"
#include "simulation/run/tip_paths.h"

namespace tress::experiments::work_precision {
namespace {

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
