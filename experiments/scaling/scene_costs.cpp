#include <algorithm>
#include <utility>

#include "contract/input_error.h"
#include "experiments/numerics/step_cost.h"
#include "experiments/problems/scene_files.h"
#include "experiments/scaling/scaling.h"
#include "models/catalogue.h"
#include "simulation/run/tip_paths.h"
#include "simulation/scene_changes/changes.h"
#include "simulation/scene_changes/typical_strands.h"

namespace tress::experiments::scaling {
namespace {

constexpr int most_strands = 64;  // without --full

void measure(const Scene& cut, const ModelEntry& model, double steps, int repeat,
             Row& row) {
  try {
    Scene scene = driven(cut, model, find_integrator("linearly_implicit_euler"));
    set_cost(step_cost(std::move(scene), timed_step, steps, repeat), row);
  } catch (const InputError& refused) {
    row.failed("refused", refused.what());
  } catch (const std::runtime_error& failed) {
    row.failed("solver_error", failed.what());
  }
}

class SceneCosts {
 public:
  SceneCosts(const CommandLine& line, const SceneFile& file) : line_(line), file_(file) {}

  std::vector<Case> cases() {
    const Scene& scene = file_.scene;
    const std::vector<int> sizes = line_.elements.empty()
                                       ? std::vector<int>{5, 10, 20, 40, 80, 160}
                                       : line_.elements;
    for (const int elements : sizes) {
      add("elements", thinned(with_elements(scene, elements), 1));
    }
    const std::size_t all =
        line_.full ? scene.strands.size()
                   : std::min<std::size_t>(scene.strands.size(), most_strands);
    for (const std::size_t n : growing(1, 2, all)) {
      if (all > 1) add("strands", only(scene, typical_strands(scene.strands, n)));
    }
    return std::move(all_);
  }

 private:
  void add(std::string_view grows, const Scene& scene) {
    for (const ModelEntry& model : model_catalogue()) {
      if (model.on_strand == nullptr || !wanted(line_.models, model.id)) continue;
      Row identity;
      identity.set("structure", file_.name).set("model", model.id).set("grows", grows);
      identity.set("elements", most_elements(scene)).set("strands", scene.strands.size());
      const double steps = line_.quick ? 20 : 200;
      all_.push_back({identity, [scene, &model, steps, repeat = line_.repeat](
                                    Row& row, const Deadline&) {
                        measure(scene, model, steps, repeat, row);
                      }});
    }
  }

  const CommandLine& line_;
  const SceneFile& file_;
  std::vector<Case> all_;
};

}  // namespace

std::vector<std::size_t> growing(std::size_t first, std::size_t factor, std::size_t all) {
  std::vector<std::size_t> list;
  for (std::size_t n = first; n < all; n *= factor) list.push_back(n);
  list.push_back(all);
  return list;
}

void set_cost(double per_step, Row& row) {
  row.set("cost_per_step_s", per_step);
  row.set("cost_per_element_step_s",
          per_step / row.number("elements") / row.number("strands"));
}

std::vector<Case> scene_costs(const CommandLine& line,
                              const std::vector<std::string>& files) {
  std::vector<Case> all;
  for (const SceneFile& file : read_strand_scenes(files)) {
    for (Case& one : SceneCosts(line, file).cases()) all.push_back(std::move(one));
  }
  if (all.empty()) {
    throw InputError("no strand model among them", line.place("models"),
                     "./tress list shows the models");
  }
  return all;
}

}  // namespace tress::experiments::scaling
