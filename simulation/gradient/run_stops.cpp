#include "simulation/gradient/run_stops.h"

#include "contract/forms/material_points.h"
#include "integrators/catalogue.h"
#include "simulation/gradient/scene_gradient.h"
#include "simulation/scene/support_table.h"

namespace tress::simulation {

std::vector<RunStop> stops_at(std::span<const double> times) {
  std::vector<RunStop> stops;
  for (const double t : times) {
    if (t > 0) stops.push_back({t, true});
  }
  return stops;
}

std::vector<double> points_at(System& system, double t, In q) {
  MaterialPoints& points = *system.material_points();
  std::vector<double> x(3 * static_cast<std::size_t>(points.count()));
  points.positions(t, q, x);
  return x;
}

AcceptedSteps accepted_steps(const Scene& scene, std::size_t strand,
                             std::span<const double> times) {
  const auto system = system_of(scene, strand);
  std::vector<double> q(static_cast<std::size_t>(system->layout().coordinates)), v(q);
  system->initial_state(q, v);
  system->accept(0, q, v);
  const auto run = integrators::make_integrator(
      scene.integrator, *system, options_beside_supports(*system, scene.options));
  AcceptedSteps accepted;
  Status s = run->start(0, q, v);
  for (const RunStop& asked : stops_at(times)) {
    if (s == Status::ok) {
      s = run->advance(asked.t, [&](double t, In, In) {
        accepted.stops.push_back({t, t == asked.t});
        return true;
      });
    }
    if (s != Status::ok) {
      accepted.unfinished = run->failure();
      return accepted;
    }
    accepted.points.push_back(points_at(*system, asked.t, run->q()));
  }
  return accepted;
}

std::vector<RunStop> divided(const std::vector<RunStop>& stops, int parts) {
  std::vector<RunStop> all;
  double from = 0;
  for (const RunStop& stop : stops) {
    for (int k = 1; k < parts; ++k) {
      all.push_back({from + (stop.t - from) * k / parts, false});
    }
    all.push_back(stop);
    from = stop.t;
  }
  return all;
}

}  // namespace tress::simulation
