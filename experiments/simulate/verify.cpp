#include "experiments/simulate/verify.h"

#include <algorithm>
#include <cmath>

#include "contract/input_error.h"
#include "simulation/run/world.h"

namespace tress::experiments::scene_runs {

void check_verifiable(const Scene& scene) {
  if (scene.options.tolerance == 0 || scene.strands.empty()) {
    throw InputError("nothing to verify in scene " + scene.name, "--verify",
                     "give strands, and [integrator] tolerance to a method that controls "
                     "its error");
  }
}

Achieved achieved_error(const Scene& scene, int threads) {
  Scene tenth = scene;
  tenth.options.tolerance /= 10;
  double length = 0;
  for (const Strand& strand : scene.strands) length = std::max(length, strand.length());
  World given(scene, threads), finer(tenth, threads);
  Achieved found;
  for (std::size_t frame = 1; frame <= scene.last_frame(); ++frame) {
    const double t = scene.time_of(frame);
    for (World* const world : {&given, &finer}) {
      if (world->advance(t) == Status::ok) continue;
      found.failure = world->failure();
      return found;
    }
    const std::vector<double>& x = given.positions();
    const std::vector<double>& y = finer.positions();
    for (std::size_t i = 0; i < x.size(); i += 3) {
      const double error =
          std::hypot(x[i] - y[i], x[i + 1] - y[i + 1], x[i + 2] - y[i + 2]) / length;
      if (error > found.error) found = {error, t, {}};
    }
  }
  return found;
}

}  // namespace tress::experiments::scene_runs
