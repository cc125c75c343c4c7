#include "simulation/run/tip_paths.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include "models/strand/points_along.h"
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

/// Reads the compared points of a world.
class Reader {
 public:
  Reader(const Scene& scene, const World& world, const ReadPoints& read) {
    std::size_t first = 0;
    for (std::size_t k = 0; k < world.strands(); ++k) {
      const auto points = static_cast<std::size_t>(world.points()[k]);
      first_.push_back(first);
      first += points;
      std::vector<models::PointBetween>& own = places_.emplace_back();
      if (read.parts == 0) {
        own.push_back({.first = points - 1, .count = 1, .weight = {1}});
        continue;
      }
      const std::vector<double> s =
          models::lengths_of_points(scene.strands[k], points, "the error along strands");
      for (int part = 0; part <= read.parts; ++part) {
        own.push_back(models::point_between(s.back() * part / read.parts, s));
      }
    }
  }

  void add(World& world, std::vector<double>& x) const {
    const std::vector<double>& all = world.positions();
    for (std::size_t k = 0; k < places_.size(); ++k) {
      for (const models::PointBetween& place : places_[k]) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          x.push_back(place.at(&all[3 * first_[k]], axis));
        }
      }
    }
  }

 private:
  std::vector<std::size_t> first_;  // points of each strand
  std::vector<std::vector<models::PointBetween>> places_;
};

}  // namespace

TipPaths tip_paths(const Scene& scene, int repeat, const RunLimit& limit,
                   const ReadPoints& read) {
  TipPaths paths;
  World world(scene);
  const Reader reader(scene, world, read);
  paths.systems = world.systems();
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
    reader.add(world, paths.x);
    if (f == 0 && read.parts > 0) paths.group = paths.x.size() / 3;
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

std::vector<double> points_at_start(const Scene& scene, const ReadPoints& read) {
  World world(scene);
  std::vector<double> x;
  Reader(scene, world, read).add(world, x);
  return x;
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

double grouped_distance(std::span<const double> a, std::span<const double> b,
                        std::size_t group) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  if (a.size() != b.size()) return infinite;
  double squares = 0;
  for (std::size_t i = 0; i < a.size();) {
    double largest = 0;
    for (const std::size_t end = i + 3 * group; i < end; i += 3) {
      const double square = std::pow(a[i] - b[i], 2) + std::pow(a[i + 1] - b[i + 1], 2) +
                            std::pow(a[i + 2] - b[i + 2], 2);
      if (!std::isfinite(square)) return infinite;
      largest = std::max(largest, square);
    }
    squares += largest;
  }
  return std::sqrt(squares * static_cast<double>(3 * group) /
                   static_cast<double>(a.size()));
}

double distance_rel(const TipPaths& a, const TipPaths& b, const Scene& scene) {
  double length = 0;
  for (const Strand& strand : scene.strands) length += strand.length();
  length /= static_cast<double>(scene.strands.size());
  return grouped_distance(a.x, b.x, a.group) / length;
}

}  // namespace tress::simulation
