#include "simulation/errors/error_bars.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "contract/input_error.h"
#include "integrators/catalogue.h"
#include "models/strand/points_along.h"
#include "simulation/errors/halved_step.h"
#include "simulation/run/remedy.h"
#include "simulation/run/timing.h"
#include "simulation/run/world.h"
#include "simulation/scene/strand_tables.h"
#include "simulation/scene_changes/changes.h"

namespace tress::simulation {
namespace {

/// A scene as it runs.
struct Run {
  Run(const Scene& scene, int threads) : world(scene, threads) {
    for (const int points : world.points()) {
      first.push_back(first.back() + static_cast<std::size_t>(points));
    }
  }

  const double* strand(std::size_t k) { return &world.positions()[3 * first[k]]; }

  World world;
  std::vector<std::size_t> first{0};  // point of every strand, and the end
};

/// Parameters of a strand's points that name the same matter in both runs.
using Places = std::vector<double>;

Places by_number(std::size_t points) {
  Places places(points);
  std::iota(places.begin(), places.end(), 0.0);
  return places;
}

/// The longest way along the points of each strand, m.
std::vector<double> lengths(Run& run) {
  const std::vector<double>& x = run.world.positions();
  const std::vector<int>& before = run.world.before();
  std::vector<double> way(before.size()), longest;
  for (std::size_t k = 0, i = 0; k < run.world.strands(); ++k) {
    longest.push_back(0);
    for (const std::size_t end = run.first[k + 1]; i < end; ++i) {
      if (before[i] < 0) continue;
      const auto j = static_cast<std::size_t>(before[i]);
      way[i] = way[j] + std::hypot(x[3 * i] - x[3 * j], x[3 * i + 1] - x[3 * j + 1],
                                   x[3 * i + 2] - x[3 * j + 2]);
      longest.back() = std::max(longest.back(), way[i]);
    }
  }
  return longest;
}

/// Compares two runs frame by frame. `factor`: the error over the distance.
class Comparison {
 public:
  Comparison(Run& given, Run& finer, double factor)
      : given_(given),
        finer_(finer),
        factor_(factor),
        lengths_(lengths(given)),
        samples_(lengths_.size()),
        squares_(lengths_.size()),
        counts_(lengths_.size()) {
    bar.strands.resize(lengths_.size());
  }

  void match(std::size_t strand, const Places& given, const Places& finer) {
    for (const double place : given)
      samples_[strand].push_back(models::point_between(place, finer));
  }

  bool done() const { return bar.parted() == bar.strands.size(); }

  void look(double t) {
    double largest = 0, squares = 0;
    std::size_t points = 0;
    std::vector<float>& of_points =
        bar.points.emplace_back(given_.first.back(), static_cast<float>(parted_from));
    for (std::size_t k = 0; k < bar.strands.size(); ++k) {
      StrandError& strand = bar.strands[k];
      if (strand.parts) continue;
      const Distances now = distances(k);
      if (!(now.largest <= parted_from)) {
        strand.parts = t;
        continue;
      }
      if (factor_ * now.largest > strand.error.largest) {
        strand.error.largest = factor_ * now.largest;
        strand.largest_at = t;
      }
      for (std::size_t i = 0; i < now.of_points.size(); ++i) {
        of_points[given_.first[k] + i] = static_cast<float>(factor_ * now.of_points[i]);
      }
      squares_[k] += now.squares;
      counts_[k] += samples_[k].size();
      strand.error.rms = rms(squares_[k], counts_[k]);
      largest = std::max(largest, now.largest);
      squares += now.squares;
      points += samples_[k].size();
    }
    if (points > 0) bar.frames.push_back({factor_ * largest, rms(squares, points)});
  }

  ErrorBar bar;

 private:
  struct Distances {
    double largest = 0, squares = 0;  // over the length
    std::vector<double> of_points;
  };

  Distances distances(std::size_t k) {
    const double* const x = given_.strand(k);
    const double* const y = finer_.strand(k);
    Distances found;
    for (std::size_t i = 0; i < samples_[k].size(); ++i) {
      double square = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        square += std::pow(x[3 * i + axis] - samples_[k][i].at(y, axis), 2);
      }
      square /= lengths_[k] * lengths_[k];
      found.squares += square;
      found.of_points.push_back(std::sqrt(square));
      found.largest = std::max(found.largest, found.of_points.back());
    }
    return found;
  }

  double rms(double squares, std::size_t count) const {
    return factor_ * std::sqrt(squares / static_cast<double>(count));
  }

  Run& given_;
  Run& finer_;
  double factor_;
  std::vector<double> lengths_;
  std::vector<std::vector<models::PointBetween>> samples_;
  std::vector<double> squares_;
  std::vector<std::size_t> counts_;
};

/// Through all frames, or to the one at which no strand is left to compare.
ErrorBar compared(const Scene& scene, Run& given, Run& finer, Comparison comparison) {
  for (std::size_t frame = 0; frame <= scene.last_frame(); ++frame) {
    const double t = scene.time_of(frame);
    for (World* const world : {&given.world, &finer.world}) {
      if (frame == 0 || world->advance(t) == Status::ok) continue;
      ErrorBar bar;
      bar.missing =
          (world == &given.world ? "" : "the finer run failed: ") + world->failure();
      bar.unfinished = true;
      return bar;
    }
    comparison.look(t);
    if (comparison.done()) break;
  }
  ErrorBar& bar = comparison.bar;
  bar.points.resize(scene.last_frame() + 1, bar.points.back());
  return std::move(bar);
}

ErrorBar missing(std::string why) {
  ErrorBar bar;
  bar.missing = std::move(why);
  return bar;
}

Scene with_tenth_of_the_tolerance(Scene scene) {
  constexpr double part = 10;
  Options& options = scene.options;
  for (double* const value : {&options.tolerance, &options.rtol, &options.atol,
                              &options.min_step, &options.step}) {
    *value /= part;  // the step is that between exchanges of strands that touch
  }
  return scene;
}

double time_factor(const Scene& scene) {
  // The finer run is without an error of its own beside that of the given scene.
  return scene.chooses_steps() ? 1 : error_over_change(scene);
}

}  // namespace

std::size_t ErrorBar::worst() const {
  const auto better = [](const StrandError& a, const StrandError& b) {
    if (a.parts && b.parts) return *a.parts > *b.parts;
    if (a.parts || b.parts) return b.parts.has_value();
    return a.error.largest < b.error.largest;
  };
  return static_cast<std::size_t>(std::ranges::max_element(strands, better) -
                                  strands.begin());
}

double ErrorBar::median() const {
  std::vector<double> largest;
  for (const StrandError& strand : strands) largest.push_back(strand.error.largest);
  return simulation::median(std::move(largest));
}

std::size_t ErrorBar::parted() const {
  return static_cast<std::size_t>(std::ranges::count_if(
      strands, [](const StrandError& strand) { return strand.parts.has_value(); }));
}

ErrorBar time_error(const Scene& scene, int threads) {
  const bool chosen = scene.chooses_steps();
  Run given(scene, threads),
      finer(chosen ? with_tenth_of_the_tolerance(scene) : scene, threads);
  // Half of `dt_s` would not do: steps end at frames, so that a run can have shorter
  // ones.
  if (!chosen) finer.world.divide_steps(2);
  if (std::ranges::min(lengths(given)) == 0) {
    return missing("the body has no length to measure errors by");
  }
  Comparison comparison(given, finer, time_factor(scene));
  for (std::size_t k = 0; k < given.world.strands(); ++k) {
    const Places places = by_number(static_cast<std::size_t>(given.world.points()[k]));
    comparison.match(k, places, places);
  }
  return compared(scene, given, finer, std::move(comparison));
}

ErrorBar distance(const Scene& scene, const Scene& finer, double factor, int threads) {
  Run given(scene, threads), other(finer, threads);
  Comparison comparison(given, other, factor);
  for (std::size_t k = 0; k < scene.strands.size(); ++k) {
    const auto places = [k](const Scene& of, const Run& run) {
      return models::lengths_of_points(
          of.strands[k], static_cast<std::size_t>(run.world.points()[k]), "space error");
    };
    comparison.match(k, places(scene, given), places(finer, other));
  }
  return compared(scene, given, other, std::move(comparison));
}

ErrorBar space_error(const Scene& scene, int threads) try {
  if (!describe_strands(scene.tables.get())) {
    return missing("the model brings its own elements, which cannot be doubled");
  }
  const double falls = std::pow(2, scene.model->order);  // the error, by doubling
  return distance(scene, with_twice_the_elements(scene), falls / (falls - 1), threads);
} catch (const InputError& error) {
  return missing(error.what());
}

void check_error_bars(const Scene& scene) {
  if (!ends_after_sweeps(find_integrator(scene.integrator))) return;
  throw InputError(
      scene.integrator +
          " ends a step after a number of sweeps, and a run with half the step does not "
          "show the error that they leave",
      "--error-bars",
      "take a method that solves its steps, such as backward_euler or tr_bdf2, or "
      "compare "
      "with a run of that method");
}

void check_verifiable(const Scene& scene) {
  if (scene.options.tolerance > 0) return;
  throw InputError(
      "nothing to verify in scene " + scene.name, "--verify",
      "give [integrator] position_tol_rel to a method that controls its error, or "
      "take --error-bars");
}

}  // namespace tress::simulation
