#include "simulation/run/tip_paths.h"

#include <cmath>
#include <iterator>
#include <stdexcept>

#include "simulation/run/timing.h"
#include "simulation/run/world.h"

namespace tress::simulation {
namespace {

void advance(World& world, double t) {
  if (world.advance(t) != Status::ok) throw std::runtime_error(world.failure());
}

/// Advances frame by frame as tip_paths does: the steps are identical to the last bit, so
/// a run that succeeded once succeeds again.
void advance_by_frames(World& world, const Scene& scene) {
  for (std::size_t f = 1; f <= scene.last_frame(); ++f) advance(world, scene.time_of(f));
}

void add_tips(World& world, std::vector<double>& tips) {
  const std::vector<double>& x = world.positions();
  std::size_t end = 0;
  for (const int points : world.points()) {
    end += 3 * static_cast<std::size_t>(points);
    tips.insert(tips.end(), &x[end - 3], &x[end - 3] + 3);
  }
}

}  // namespace

TipPaths tip_paths(const Scene& scene, int repeat, const RunLimit& limit) {
  TipPaths paths;
  World world(scene);
  const ThreadTimer timer;
  for (std::size_t f = 0; f <= scene.last_frame(); ++f) {
    if (f > 0) advance(world, scene.time_of(f));
    if (timer.wall_s() > limit.wall_s || timer.seconds() > limit.own_s)
      throw std::runtime_error("takes too long");
    const Stats stats = world.stats();
    if (static_cast<double>(stats.newton_iterations) >
        limit.iterations_per_step * static_cast<double>(stats.steps)) {
      throw std::runtime_error("takes too many iterations");
    }
    add_tips(world, paths.x);
    if (limit.useless && limit.useless(paths.x)) {
      throw std::runtime_error("is too far off");
    }
  }
  paths.once_s = timer.seconds();
  paths.indicator = world.error_indicator();
  paths.stats = world.stats();
  paths.work = world.work();
  if (repeat == 0) return paths;
  if (paths.once_s > long_run_s) {
    paths.wall_s = paths.once_s;
    return paths;
  }
  const Snapshot start = World(scene).snapshot();
  paths.wall_s = time_run(repeat, [&] {
    world.restore(start);
    advance_by_frames(world, scene);
  });
  return paths;
}

std::vector<double> wall_times(const Scene& guarded, int runs, double at_least_s) {
  Scene scene = guarded;
  scene.guard = false;
  World world(scene);
  const Snapshot start = world.snapshot();
  std::vector<double> times;
  for (double all = 0; std::ssize(times) < runs || all < at_least_s;) {
    world.restore(start);
    const ThreadTimer timer;
    advance_by_frames(world, scene);
    times.push_back(timer.seconds());
    all += times.back();
  }
  return times;
}

double distance_rel(const TipPaths& a, const TipPaths& b, const Scene& scene) {
  double squares = 0, length = 0;
  for (std::size_t i = 0; i < a.x.size(); ++i) squares += std::pow(a.x[i] - b.x[i], 2);
  for (const Strand& strand : scene.strands) length += strand.length();
  length /= static_cast<double>(scene.strands.size());
  return std::sqrt(squares / (static_cast<double>(a.x.size()) / 3)) / length;
}

}  // namespace tress::simulation
