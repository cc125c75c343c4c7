#include "experiments/cost_of_accuracy/scene_measure.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>

#include "contract/input_error.h"
#include "integrators/catalogue.h"
#include "simulation/run/timing.h"
#include "simulation/run/tip_paths.h"

namespace tress::experiments::cost_of_accuracy {
namespace {

/// Shorter runs are repeated: reading the clock at every frame contributes to them.
constexpr double short_run = 0.01;  // s
constexpr int short_repeats = 3;

/// Runs that are timed again take at least this long in total: caches and clock rates
/// settle.
constexpr double long_enough = 0.01;  // s

/// Mean iterations of a stage beyond which no run is the cheapest: an undisturbed one
/// takes three or four, and halving the step reduces them.
constexpr double most_iterations = 10;

/// Coordinates of an element, at most, and calls of an iteration: a residual, a matrix, a
/// solution.
constexpr double most_coordinates = 7, calls = 3;

int stages(const Method& method) {
  return std::max(1, find_integrator(method.integrator).stages);
}

/// A run's scene with longer or shorter steps, or changed data.
Scene neighbour(Scene scene, Neighbour which) {
  const auto with = [&scene](double factor) {
    scene.options.step *= factor;
    scene.options.tolerance *= factor;
    return std::move(scene);
  };
  switch (which) {
    case Neighbour::shorter_steps:
      return with(shorter);
    case Neighbour::longer_steps:
      return with(longer);
    case Neighbour::data_up:
      return changed(std::move(scene), Change::up);
    case Neighbour::data_down:
      return changed(std::move(scene), Change::down);
    case Neighbour::one_more_element:
    case Neighbour::two_more:
      break;
  }
  throw std::logic_error("a run of its own");
}

}  // namespace

WallTime wall_time(const std::vector<double>& seconds) {
  double least[] = {seconds.front(), seconds.back()};
  for (std::size_t i = 0; i < seconds.size(); ++i) {
    least[i % 2] = std::min(least[i % 2], seconds[i]);
  }
  const auto [low, high] = std::minmax(least[0], least[1]);
  return {low, high / low - 1};
}

Scene SceneMeasure::scene(const Method& method, int elements, int substeps) const {
  Scene run = compared(trial_scene(given_, method, elements, substeps, comparison_.rate),
                       comparison_);
  // A tolerance does not say how many steps a run takes: where the next solution is far
  // some methods find no way.
  const long most_steps = std::max(1L, longest_run_ / elements);
  if (method.by_tolerance) run.options.max_steps = most_steps;
  // A step without a solution is tried again many times before the iterations of a frame
  // are counted.
  const auto steps =
      static_cast<double>(comparison_.frames) *
      static_cast<double>(method.by_tolerance ? most_steps : long{substeps});
  run.options.max_work = most_iterations * stages(method) * steps * calls *
                         (most_coordinates * elements + 10);
  return run;
}

const std::vector<double>& SceneMeasure::reference(std::optional<Neighbour> of) const {
  if (of == Neighbour::data_up) return changed_.up;
  return of == Neighbour::data_down ? changed_.down : reference_;
}

std::function<bool(const std::vector<double>&)> SceneMeasure::useless(
    const std::vector<double>& reference) const {
  if (useless_ == never) return {};
  const std::size_t first = reference.size() / (comparison_.frames + 1);
  const std::size_t group = comparison_.group(reference.size() / 3);
  const auto groups = [group](std::size_t values) {
    return static_cast<double>(values) / static_cast<double>(3 * group);
  };
  const double most =
      std::pow(useless_ * comparison_.length, 2) * groups(reference.size() - first);
  return [&reference, most, group, groups, seen = first,
          squares = 0.0](const std::vector<double>& x) mutable {
    const std::size_t end = std::min(x.size(), reference.size());
    if (end <= seen) return false;
    const std::span<const double> now(x), exact(reference);
    const double distance = simulation::grouped_distance(
        now.subspan(seen, end - seen), exact.subspan(seen, end - seen), group);
    squares += distance * distance * groups(end - seen);
    seen = end;
    return !(squares <= most);
  };
}

SceneMeasure::Outcome SceneMeasure::outcome(const Method& method, int elements,
                                            int substeps, double most_s,
                                            std::optional<Neighbour> as,
                                            double most_own_s) const {
  const auto of = [&](int count) {
    Scene run = scene(method, count, substeps);
    if (as) run = neighbour(std::move(run), *as);
    RunLimit limit{most_iterations * stages(method), most_s, most_own_s};
    if (count == elements) limit.useless = useless(reference(as));
    return compared_paths(run, comparison_, limit);
  };
  TipPaths fine = of(elements);
  // Strands without supports and joints may share a system, but not steps.
  const std::size_t systems = comparison_.read.parts > 0
                                  ? fine.systems
                                  : fine.x.size() / 3 / (comparison_.frames + 1);
  Outcome made{std::move(fine.x), fine.once_s, fine.work, fine.indicator,
               static_cast<double>(fine.stats.steps) / static_cast<double>(systems)};
  if (!method.extrapolated) return made;
  const int few = coarser(elements);
  if (few == elements) {
    throw InputError("nothing to extrapolate from", "elements", "take two at least");
  }
  const TipPaths coarse = of(few);
  const double factor = extrapolation(method, elements);
  for (std::size_t i = 0; i < made.tips.size(); ++i) {
    made.tips[i] += factor * (made.tips[i] - coarse.x[i]);
  }
  made.once_s += coarse.once_s;
  made.work += coarse.work;
  made.indicator = std::max(made.indicator, coarse.indicator);
  return made;
}

WallTime SceneMeasure::repeated(const Method& method, int elements, int substeps,
                                int count, double at_least_s) const {
  const auto of = [&](int elements_of_one) {
    return wall_time(
        wall_times(scene(method, elements_of_one, substeps), count, at_least_s));
  };
  WallTime all = of(elements);
  if (!method.extrapolated) return all;
  const WallTime coarse = of(coarser(elements));
  return {all.least_s + coarse.least_s, std::max(all.scatter, coarse.scatter)};
}

std::optional<Trial> SceneMeasure::quick(const Method& method, int elements, int substeps,
                                         double most_s, double most_own_s) const {
  try {
    const Outcome run = outcome(method, elements, substeps, most_s, {}, most_own_s);
    const double wall_s =
        run.once_s < short_run
            ? repeated(method, elements, substeps, short_repeats, 0).least_s
            : run.once_s;
    Trial made{0, elements, substeps, compared_error(run.tips, reference_, comparison_),
               wall_s};
    made.work = run.work;
    made.indicator = run.indicator;
    made.steps = run.steps;
    return made;
  } catch (const InputError&) {  // refused at this number of elements
    return {};
  } catch (const std::runtime_error&) {
    return {};
  }
}

double SceneMeasure::neighbour_error(const Method& method, int elements, int substeps,
                                     Neighbour which, double most_s) const {
  try {
    return compared_error(outcome(method, elements, substeps, most_s, which).tips,
                          reference(which), comparison_);
  } catch (const std::runtime_error&) {  // including refusals: InputError is one
    return never;
  }
}

std::optional<Trial> SceneMeasure::best_of(const Scene& given, int count, double most_s,
                                           std::string& why) const {
  const Scene run = compared(given, comparison_);
  try {
    const TipPaths paths = compared_paths(run, comparison_, {.wall_s = most_s});
    const bool once = paths.once_s > long_run_s;
    Trial made{
        0, 0, 0, compared_error(paths.x, reference_, comparison_),
        once ? paths.once_s : wall_time(wall_times(run, count, long_enough)).least_s};
    made.indicator = paths.indicator;
    return made;
  } catch (const std::runtime_error& failure) {
    why = failure.what();
    return {};
  }
}

WallTime SceneMeasure::time(const Method& method, int elements, int substeps,
                            int count) const {
  return repeated(method, elements, substeps, count, long_enough);
}

double SceneMeasure::error(const Method& method, int elements, int substeps,
                           const std::vector<double>& reference) const {
  return compared_error(outcome(method, elements, substeps).tips, reference, comparison_);
}

}  // namespace tress::experiments::cost_of_accuracy
