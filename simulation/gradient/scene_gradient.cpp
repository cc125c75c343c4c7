#include "simulation/gradient/scene_gradient.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "contract/forms/material_points.h"
#include "contract/forms/moving_history.h"
#include "integrators/catalogue.h"
#include "integrators/gradient/adjoint_run.h"
#include "integrators/gradient/gradient_run.h"
#include "simulation/gradient/contact_at_stops.h"
#include "simulation/gradient/run_stops.h"
#include "simulation/scene/strand_tables.h"
#include "simulation/scene/support_table.h"

namespace tress::simulation {
namespace {

using integrators::AdjointRun;
using integrators::GradientRun;
using integrators::GradientStart;
using integrators::RunParameter;

double farthest(const std::vector<double>& x, const std::vector<double>& y) {
  double most = 0;
  for (std::size_t i = 0; i + 2 < x.size(); i += 3) {
    most =
        std::max(most, std::hypot(x[i] - y[i], x[i + 1] - y[i + 1], x[i + 2] - y[i + 2]));
  }
  return most;
}

GradientRun::Method method_of(const Scene& scene, bool with_damping) {
  GradientRun::Method method{.id = scene.integrator, .options = scene.options};
  method.start = with_damping ? GradientStart::damped : GradientStart::as_run;
  method.forces = known_forces(scene);
  if (scene.options.tolerance == 0) return method;
  constexpr double one_step = 1e30;  // to the next stop
  method.options.tolerance = 0;
  method.options.step = one_step;
  return method;
}

/// The run of one strand at the times of a task, with its derivatives.
class StrandRun {
 public:
  StrandRun(const Scene& scene, std::size_t strand, const GradientTask& task)
      : scene_(scene),
        strand_(strand),
        task_(task),
        chosen_(scene.options.tolerance > 0),
        system_(system_of(scene, strand)),
        own_(points_of(scene, strand)),
        parameters_(run_parameters(scene, strand, task.parameters)),
        method_(method_of(scene, task.damped)) {
    check_starts(scene, strand, *system_, task.parameters);
    method_.options = options_beside_supports(*system_, method_.options);
    if (chosen_) accepted_ = accepted_steps(scene, strand, task.times);
    stops_ = chosen_ ? divided(accepted_.stops, task.parts) : stops_at(task.times);
    if (!chosen_) method_.parts = task.parts;
    found_.by.resize(task.parameters.size());
    found_.unfinished = accepted_.unfinished;
  }

  StrandGradient gradient(bool adjoint) {
    found_.adjoint = adjoint;
    adjoint ? backward() : forward();
    found_.not_smooth = not_smooth(*system_);
    const std::size_t first = from_start() ? 1 : 0;
    for (std::size_t f = first; f < found_.points.size() && chosen_; ++f) {
      found_.moved = std::max(
          found_.moved, farthest(found_.points[f], own(accepted_.points[f - first])) /
                            scene_.strands[strand_].length());
    }
    if (found_.unfinished.empty() && found_.moved > scene_.options.tolerance) {
      found_.unfinished = fmt::format(
          "with its steps frozen, the run ends {:.2g} of the length away from that with "
          "error control: give dt_s, or a smaller position_tol_rel",
          found_.moved);
    }
    return std::move(found_);
  }

 private:
  bool from_start() const { return !task_.times.empty() && task_.times.front() <= 0; }

  /// The coordinates of the strand's points among those of its system.
  std::vector<double> own(const std::vector<double>& x) const {
    const auto begin = x.begin() + static_cast<std::ptrdiff_t>(3 * own_.first);
    return {begin, begin + static_cast<std::ptrdiff_t>(3 * own_.count)};
  }

  /// see(k) at every time, where k advances have led to it.
  template <class Run, class See>
  Status take(Run& run, See see) {
    Status s = run.start();
    const auto note = [&](std::size_t advances) {
      found_.points.push_back(own(points_at(*system_, run.time(), run.q())));
      see(advances);
    };
    if (s == Status::ok && from_start()) note(0);
    for (std::size_t k = 0; k < stops_.size() && s == Status::ok; ++k) {
      const double before = run.time();
      s = run.advance(stops_[k].t);
      longest_step_ =
          std::max(longest_step_, std::min(run.time() - before, method_.options.step));
      if (s == Status::ok && stops_[k].asked) note(k + 1);
    }
    if (s != Status::ok) found_.unfinished = run.failure();
    return s;
  }

  void forward() {
    GradientRun run(*system_, exact_system_of(scene_, strand_), parameters_, method_,
                    copies_of(scene_, strand_));
    std::vector<double> dx(3 *
                           static_cast<std::size_t>(system_->material_points()->count()));
    static_cast<void>(take(run, [&](std::size_t) {
      for (std::size_t k = 0; k < found_.by.size(); ++k) {
        run.points_by(k, dx);
        found_.by[k].push_back(own(dx));
        for (double& entry : found_.by[k].back()) entry /= task_.parameters[k].measure;
      }
    }));
    for (std::size_t f = 0; f < found_.points.size(); ++f) {
      found_.near_contact_change.push_back(
          near_change(run.contact_changes(), task_.times[f], longest_step_));
    }
  }

  /// A run that fails has derivatives up to there, except at the last frame.
  void backward() {
    AdjointRun run(*system_, exact_system_of(scene_, strand_), parameters_, method_);
    std::vector<std::size_t> advances;  // of each time
    static_cast<void>(take(run, [&](std::size_t k) { advances.push_back(k); }));
    const std::size_t times = found_.points.size();
    if (times == 0) return;
    const std::size_t all = found_.points.front().size();
    const std::size_t width = task_.of == GradientOf::points ? all : 3;
    const std::size_t first = task_.of == GradientOf::last_tip ? times - 1 : 0;
    const std::size_t numbers = (times - first) * width;
    std::vector<double> by(numbers * parameters_.size());
    const auto seed = [&](std::size_t number, std::size_t stop, Out x_hat) {
      if (advances[first + number / width] != stop) return;
      x_hat[3 * own_.first + all - width + number % width] = 1;
    };
    if (run.sweep(numbers, seed, by) != Status::ok) {
      found_.unfinished = run.failure();
      found_.frames_moved = run.frames_moved();
      if (found_.frames_moved) found_.unfinished += " (way = \"forward\")";
      found_.points.clear();
      return;
    }
    for (std::size_t k = 0; k < found_.by.size(); ++k) {
      found_.by[k].assign(times, std::vector<double>(all));
      for (std::size_t i = 0; i < numbers; ++i) {
        found_.by[k][first + i / width][all - width + i % width] =
            by[i * parameters_.size() + k] / task_.parameters[k].measure;
      }
    }
  }

  const Scene& scene_;
  std::size_t strand_;
  const GradientTask& task_;
  bool chosen_;  // steps by a tolerance
  std::unique_ptr<System> system_;
  PointRange own_;
  std::vector<RunParameter> parameters_;
  GradientRun::Method method_;
  AcceptedSteps accepted_;
  std::vector<RunStop> stops_;
  StrandGradient found_;
  double longest_step_ = 0;  // s
};

}  // namespace

bool starts_damped(std::string_view start, std::span<const SceneParameter> parameters) {
  if (start != "auto") return start == "damped";
  return std::ranges::any_of(parameters, &SceneParameter::moves_rest);
}

std::vector<double> times_of_frames(const Scene& scene) {
  std::vector<double> times;
  for (std::size_t f = 0; f <= scene.last_frame(); ++f) times.push_back(scene.time_of(f));
  return times;
}

StrandGradient strand_gradient(const Scene& scene, std::size_t strand,
                               const GradientTask& task) {
  bool adjoint = task.way == GradientWay::adjoint;
  if (task.way == GradientWay::automatic) {
    const auto system = exact_system_of(scene, strand);
    const auto numbers =
        3 * (task.of == GradientOf::points ? points_of(scene, strand).count : 1);
    const std::size_t frames = task.of == GradientOf::last_tip ? 1 : task.times.size();
    adjoint = task.parameters.size() > 3 * numbers * frames &&
              integrators::no_adjoint(*system, scene.integrator, scene.options).empty();
  }
  StrandGradient found = StrandRun(scene, strand, task).gradient(adjoint);
  const bool again = found.frames_moved && task.way == GradientWay::automatic;
  return again ? StrandRun(scene, strand, task).gradient(false) : found;
}

GradientOf gradient_of(std::string_view word) {
  return word == "tip"        ? GradientOf::tip
         : word == "last_tip" ? GradientOf::last_tip
                              : GradientOf::points;
}

GradientWay gradient_way(std::string_view word) {
  return word == "forward"   ? GradientWay::forward
         : word == "adjoint" ? GradientWay::adjoint
                             : GradientWay::automatic;
}

double count_of_derivatives(const Scene& scene) {
  const GradientOf of = gradient_of(scene.tables->gradient->values().word("of"));
  const auto frames = static_cast<double>(
      of == GradientOf::last_tip ? std::size_t{1} : scene.last_frame() + 1);
  double points = 0;
  for (std::size_t k = 0; k < scene.strands.size(); ++k) {
    points +=
        of == GradientOf::points ? static_cast<double>(points_of(scene, k).count) : 1;
  }
  return 3 * points * frames * static_cast<double>(gradient_parameters(scene).size());
}

SceneGradient scene_gradient(const Scene& scene, int parts) {
  SceneGradient all;
  all.parameters = gradient_parameters(scene);
  all.damped =
      starts_damped(scene.tables->gradient->values().word("start"), all.parameters);
  const Parameters& asked = scene.tables->gradient->values();
  const GradientTask task{all.parameters,
                          all.damped,
                          times_of_frames(scene),
                          parts,
                          gradient_of(asked.word("of")),
                          gradient_way(asked.word("way"))};
  for (std::size_t k = 0; k < scene.strands.size(); ++k) {
    all.strands.push_back(strand_gradient(scene, k, task));
  }
  return all;
}

}  // namespace tress::simulation
