#include "experiments/cost_of_gradient/gradient_course.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>

#include "contract/forms/material_points.h"
#include "contract/jacobian_choice.h"
#include "simulation/run/timing.h"
#include "simulation/scene/gradient_table.h"
#include "simulation/scene_changes/changes.h"

namespace tress::experiments::cost_of_gradient {
namespace {

using integrators::GradientRun;
using integrators::RunParameter;
using simulation::Scene;
using simulation::SceneParameter;

// The hair of the gradient's documentation, at ten frames.
constexpr std::string_view hair = R"(title = "hair"
frames_per_s = 40
duration_s = 0.25
[model]
id = "super_helix"
[integrator]
id = "tr_bdf2"
[material]
internal_friction_kg_m3_s = 1e-10
[effects.gravity]
[effects.linear_drag]
drag_kg_m_s = 5e-5
[gradient]
by = ["youngs_modulus_pa"]
)";
constexpr std::string_view curled = R"([strand]
length_m = 0.1
elements = 10
shape = "helix"
[root]
motion = "swing"
amplitude_m = 0.005
frequency_hz = 3
)";
constexpr std::string_view falling = R"([strand]
length_m = 0.1
elements = 10
[root]
[effects.body]
centre_m = [0, 0, -0.03]
)";

Scene read(std::string_view strand, std::string_view more, const std::string& name) {
  return simulation::parse_scene(
      std::string(hair) + std::string(strand) + std::string(more), name + ".toml");
}

std::vector<SceneParameter> scene_parameters(const Scene& scene) {
  std::vector<std::string> names;
  for (const ByParameter& by : parameters) names.emplace_back(by.name);
  return simulation::gradient_parameters(scene, names, "cost_of_gradient");
}

Scene with_elastic(Scene scene) {
  scene.model_options.set(jacobian_parameter.name, "elastic");
  return scene;
}

std::vector<double> tip(std::vector<double> points) {
  points.erase(points.begin(), points.end() - 3);
  return points;
}

double norm(const std::vector<double>& x) {
  double sum = 0;
  for (const double entry : x) sum += entry * entry;
  return std::sqrt(sum);
}

std::vector<double> difference(std::vector<double> x, const std::vector<double>& y) {
  for (std::size_t i = 0; i < x.size(); ++i) x[i] -= y[i];
  return x;
}

std::vector<double> limit(const std::vector<double>& coarse,
                          const std::vector<double>& fine) {
  std::vector<double> x = fine;
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += (fine[i] - coarse[i]) / 3;
  return x;
}

void append(std::vector<double>& all, const std::vector<double>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

/// Runs to all frames. Empty where it reached the end.
std::string run_to_end(const Scene& scene, GradientRun& run, MaterialPoints& points,
                       Course& found) {
  std::vector<double> x(3 * static_cast<std::size_t>(points.count()));
  Status s = run.start();
  for (std::size_t f = 1; f <= scene.last_frame() && s == Status::ok; ++f) {
    s = run.advance(scene.time_of(f));
    if (s != Status::ok) break;
    points.positions(run.time(), run.q(), x);
    append(found.tips, tip(x));
    for (std::size_t k = 0; k < found.by.size(); ++k) {
      run.points_by(k, x);
      append(found.by[k], tip(x));
    }
  }
  return run.failure();
}

}  // namespace

Scene curl() { return read(curled, "", "curl"); }
Scene fall(std::string_view body) { return read(falling, body, "fall"); }

Scene with(const Scene& scene, std::string_view model, std::string_view integrator,
           int elements) {
  simulation::Method method;
  method.model = &models::find_model(model);
  method.integrator = integrator;
  Scene changed = with_elements(with_method(scene, method), elements);
  if (system_of(changed)->layout().constraints > 0) {
    changed.options.formulation = Formulation::index3;
  }
  return changed;
}

std::unique_ptr<System> system_of(const Scene& scene) {
  return scene.model->on_strand(scene.strands.front(), scene.model_options,
                                simulation::make_effects(scene));
}

Course course(const Scene& scene, int steps, const Way& way) {
  const Scene own = way.elastic ? with_elastic(scene) : scene;
  Course found;
  const std::vector<SceneParameter> all = scene_parameters(scene);
  found.by.resize(all.size());
  std::vector<RunParameter> by;
  for (const SceneParameter& parameter : all) {
    by.emplace_back([&scene, &parameter](double s) {
      Scene changed = scene;
      parameter.change(changed, s);
      return system_of(changed);
    });
  }
  GradientRun::Method method{.id = scene.integrator, .options = scene.options};
  method.options.step = scene.duration / steps;
  method.start = way.start;
  // The elastic Jacobian is not the derivative of the residual.
  method.forces.sparse = !way.elastic;
  const auto system = system_of(own);
  GradientRun run(*system, system_of(own), by, method);
  const simulation::ThreadTimer timer;
  found.failure = run_to_end(scene, run, *system->material_points(), found);
  found.time_s = timer.seconds();
  found.linearizations = run.stats().linearizations;
  return found;
}

double tip_distance(const Course& one, const Course& other) {
  const double frames = static_cast<double>(one.tips.size()) / 3;
  return norm(difference(one.tips, other.tips)) / std::sqrt(frames);
}

double relative_error(const Course& one, const Course& reference, std::size_t k) {
  return norm(difference(one.by[k], reference.by[k])) / norm(reference.by[k]);
}

double relative_error(const Course& one, const Course& reference) {
  double worst = 0;
  for (std::size_t k = 0; k < one.by.size(); ++k) {
    const double error = relative_error(one, reference, k);
    if (!(error <= worst)) worst = error;  // NaN, too
  }
  return worst;
}

Course extrapolated(const Course& coarse, const Course& fine) {
  Course at_limit = fine;
  at_limit.tips = limit(coarse.tips, fine.tips);
  for (std::size_t k = 0; k < fine.by.size(); ++k) {
    at_limit.by[k] = limit(coarse.by[k], fine.by[k]);
  }
  return at_limit;
}

}  // namespace tress::experiments::cost_of_gradient
