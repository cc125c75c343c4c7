#include "experiments/numerics/step_cost.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "simulation/run/timing.h"
#include "simulation/run/world.h"

namespace tress::experiments {

double step_cost(Scene scene, double dt, double steps, int repeat) {
  constexpr double most_steps = 200;
  const double count = std::min(most_steps, std::ceil(steps - 1e-9));
  scene.options.step = dt;
  scene.guard = false;
  World world(scene);
  const Snapshot start = world.snapshot();
  const double wall = time_run(repeat, [&] {
    world.restore(start);
    if (world.advance(count * dt) != Status::ok) {
      throw std::runtime_error(world.failure());
    }
  });
  return wall / count;
}

}  // namespace tress::experiments
