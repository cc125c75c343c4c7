#include <cmath>

#include "experiments/constraint_drift/constraint_drift.h"
#include "experiments/numerics/amplification.h"
#include "experiments/numerics/drift_monitor.h"
#include "models/catalogue.h"
#include "simulation/run/simulation.h"

namespace tress::experiments::constraint_drift {
namespace {

constexpr std::string_view bead = "bead_on_wire";
constexpr int steps = 20'000;  // a radius of 1.00035 grows the violation 1000-fold
constexpr double start_violation = 1e-6;  // m, far inside the linear range
constexpr double growth = 1e3;

// A swing of 0.1 rad about the bottom (-pi/2): the method's own drift, which grows as the
// speed squared and as 1/alpha, stays below the growth to be detected.
constexpr const char* gentle_start = "-1.4708";

/// Above this (sqrt(alpha) dt) the method counts as unlimited.
constexpr double beyond = 50;

// Weakly damped growth has to be fast enough to be measurable.
constexpr double least_measured = 0.099, most_measured = 10.01;  // zeta

struct FeedbackLimit {
  std::string_view integrator;
  double zeta;
  Parameters parameters;
  Options options;
};

/// Whether a swinging bead on a circle keeps a small violation small.
bool stays(const FeedbackLimit& limit, double omega_h) {
  const auto system = find_model(bead).make(limit.parameters);
  State start = initial_state(*system);
  start.q[2] -= start_violation;  // near the bottom z is the normal
  Options options = limit.options;
  const double omega = omega_h / options.step;
  options.alpha = omega * omega;
  options.beta = 2 * limit.zeta * omega;
  DriftMonitor monitor(*system, start.q, start.v, growth * start_violation);
  const Simulation run =
      simulate(limit.integrator, *system, options, start, steps * options.step,
               [&monitor](double t, In q, In v) { return monitor(t, q, v); });
  return run.status == Status::ok;
}

double measured(const FeedbackLimit& limit, double guess) {
  double low = 0.5 * guess, high = 2 * guess;
  while (high - low > 2e-3 * guess) {
    const double middle = 0.5 * (low + high);
    (stays(limit, middle) ? low : high) = middle;
  }
  return low;
}

void measure(const FeedbackLimit& limit, Row& row) {
  const auto predicted = largest_stable_omega_h(limit.integrator, limit.zeta);
  if (!predicted) {
    if (stays(limit, beyond)) return;  // no limit predicted, none found
    row.failed("unstable", "predicted to have no limit, diverged at omega h = 50");
    return;
  }
  row.set("omega_h_predicted", *predicted);
  if (limit.zeta < least_measured || limit.zeta > most_measured) return;
  const double found = measured(limit, *predicted);
  row.set("omega_h_measured", found).set("rel_gap", found / *predicted - 1);
}

}  // namespace

std::vector<Case> feedback_limits(const CommandLine& line, const Settings& user) {
  std::vector<Case> all;
  if (!wanted(line.models, bead)) return all;
  Parameters parameters = user.parameters(find_model(bead));
  for (const auto& [key, value] : {std::pair{"curve", "circle"},
                                   {"form", "implicit"},
                                   {"start_rad", gentle_start}}) {
    parameters.set(key, value);
  }
  Options options = user.options();
  options.formulation = Formulation::baumgarte;
  const int per_decade = line.full ? 12 : 6;  // from 0.001 to 1000
  for (const std::string_view id :
       {"explicit_euler", "symplectic_euler", "velocity_verlet", "rk4",
        "linearly_implicit_euler", "backward_euler", "bdf2", "implicit_midpoint"}) {
    if (!wanted(line.integrators, id)) continue;
    for (int i = 0; i <= 6 * per_decade; ++i) {
      const double zeta = 0.001 * std::pow(10, static_cast<double>(i) / per_decade);
      Row row;
      row.set("study", "limit").set("system", "circle bead");
      row.set("formulation", name(options.formulation)).set("integrator", id);
      row.set("zeta", zeta).set("dt_s", options.step);
      const FeedbackLimit limit{id, zeta, parameters, options};
      all.push_back(
          {row, [limit](Row& of_case, const Deadline&) { measure(limit, of_case); }});
    }
  }
  return all;
}

}  // namespace tress::experiments::constraint_drift
