#include <algorithm>
#include <cmath>
#include <span>

#include "experiments/cost_of_gradient/cost_of_gradient.h"
#include "simulation/fit/scene_fit.h"
#include "simulation/scene/gradient_table.h"

namespace tress::experiments::cost_of_gradient {
namespace {

using simulation::PointRecord;
using simulation::Scene;
using simulation::SceneParameter;

constexpr std::string_view method_of_record = "esdirk43";
// Where a fit starts, over the true values less 1, in the order of `parameters`. With a
// curvature that is far off, other windings of the curl fit as well.
constexpr double too_large[] = {0.25, 0.25, 0.25, 0.03};

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const ByParameter& by : parameters) all.emplace_back(by.name);
  return all;
}

/// The tip at the frames of a scene, without noise.
PointRecord record_of(const Scene& scene, const Course& run) {
  PointRecord record;
  record.file = "record";
  for (std::size_t f = 0; 3 * f < run.tips.size(); ++f) {
    for (std::size_t c = 0; c < 3; ++c) {
      record.observations.push_back({.t = scene.time_of(f + 1),
                                     .component = c,
                                     .value = run.tips[3 * f + c],
                                     .row = f});
    }
    record.places.emplace_back();
  }
  return record;
}

/// Row of one fit. `truth`: parameters of the record.
void fit(Scene scene, int steps, const PointRecord& record,
         std::span<const SceneParameter> truth, Row& row) {
  scene.options.step = scene.duration / steps;
  for (std::size_t k = 0; k < truth.size(); ++k) {
    truth[k].change(scene, too_large[k] * truth[k].value / truth[k].measure);
  }
  const simulation::SceneFit found =
      simulation::fit_scenes({.records = {{&scene, &record}},
                              .by = names(),
                              .bounds = {},
                              .priors = {},
                              .shifts = false});
  row.set("evaluations", found.evaluations);
  if (found.status == "solver_error") {
    row.failed("solver_error", found.reason);
    return;
  }
  double worst = 0;
  for (std::size_t k = 0; k < truth.size(); ++k) {
    const double error = std::abs(found.parameters[k].value / truth[k].value - 1);
    row.set(parameters[k].column, error);
    worst = std::max(worst, error);
  }
  row.set("gradient_error_rel", worst).set("tip_error_rel", found.rms / strand_length);
}

}  // namespace

std::vector<Row> fit_rows(const Row& own, const Sweep& sweep) {
  const std::string_view model = own.text("model");
  const Scene given = curl();
  const Scene finest = with(given, model, method_of_record, usual_elements);
  const Course run = course(finest, sweep.reference_steps);
  const PointRecord record = record_of(finest, run);
  const auto truth = simulation::gradient_parameters(finest, names(), "cost_of_gradient");
  std::vector<Row> rows;
  for (const std::string_view method : gradient_methods(finest, sweep.integrators)) {
    const Scene scene = with(given, model, method, usual_elements);
    for (const int steps : sweep.steps) {
      Row& row = rows.emplace_back(own);
      row.set("integrator", method).set("elements", usual_elements).set("steps", steps);
      row.set("start", "damped").set("jacobian", "exact");
      if (run.failure.empty()) {
        fit(scene, steps, record, truth, row);
      } else {
        row.failed("solver_error", run.failure);
      }
    }
  }
  return rows;
}

}  // namespace tress::experiments::cost_of_gradient
