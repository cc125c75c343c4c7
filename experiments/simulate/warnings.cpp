#include "experiments/simulate/warnings.h"

#include <fmt/format.h>

#include <cmath>

#include "simulation/run/dissipation_warning.h"

namespace tress::experiments::scene_runs {

std::vector<std::string> warnings(const Scene& scene, const SceneRun& run) {
  std::vector<std::string> all;
  const double share = run.dissipation ? run.dissipation->share() : 0;
  if (run.dissipation && simulation::warns(*run.dissipation)) {
    all.push_back(fmt::format(
        "{} {} {:.2g} J, {:.2g} % of the energy of the motion: {}", scene.integrator,
        share > 0 ? "dissipated" : "created", std::abs(run.dissipation->dissipated),
        100 * std::abs(share),
        scene.chooses_steps() ? "take a smaller tolerance"
                              : "take a shorter dt_s, or a method of order 2 or more"));
  }
  if (!run.not_smooth.empty()) {
    all.push_back(fmt::format(
        "the motion is not smooth, and no dt_s or tolerance controls its error: {}; take "
        "a model with material frames, such as der or super_helix",
        run.not_smooth));
  }
  return all;
}

}  // namespace tress::experiments::scene_runs
