// How large may Baumgarte's gains be before the feedback itself diverges, and does the
// linear theory of each method predict it?
#include <cmath>
#include <string>
#include <vector>

#include "experiments/numerics/amplification.h"
#include "experiments/numerics/drift_monitor.h"
#include "experiments/run/experiment.h"
#include "simulation/run/simulation.h"

namespace tress {
namespace {

constexpr Column columns[] = {
    {"integrator", "method"},
    {"zeta", "damping ratio beta / (2 sqrt alpha)"},
    {"dt_s", "step"},
    {"omega_h_predicted", "limit of sqrt(alpha) dt from the method's step matrix"},
    {"omega_h_measured",
     "largest sqrt(alpha) dt at which a swinging bead stays on its wire"},
    {"rel_gap", "measured over predicted, minus one"},
};

constexpr double dt = 1e-3;    // s
constexpr int steps = 20'000;  // a radius of 1.00035 grows the violation 1000-fold
constexpr double start_violation = 1e-6;  // m, far inside the linear range
constexpr double growth = 1e3;

// A swing of 0.1 rad about the bottom (-pi/2): the method's own drift, which grows as the
// speed squared and as 1/alpha, stays below the growth that is looked for.
constexpr const char* gentle_start = "-1.4708";

/// Whether a swinging bead on a circle keeps a small violation small.
bool stays(std::string_view integrator, double omega_h, double zeta) {
  const auto bead = make_model(
      "bead_on_wire",
      {{"curve", "circle"}, {"form", "implicit"}, {"start_rad", gentle_start}});
  State start = initial_state(*bead);
  start.q[2] -= start_violation;  // near the bottom z is the normal
  Options options;
  options.formulation = Formulation::baumgarte;
  options.step = dt;
  const double omega = omega_h / dt;
  options.alpha = omega * omega;
  options.beta = 2 * zeta * omega;
  DriftMonitor monitor(*bead, start.q, start.v, growth * start_violation);
  const Simulation run =
      simulate(integrator, *bead, options, start, steps * dt,
               [&monitor](double t, In q, In v) { return monitor(t, q, v); });
  return run.status == Status::ok;
}

// Above this the method is called unlimited.
constexpr double beyond = 50;

double measured_limit(std::string_view integrator, double zeta, double guess) {
  double low = 0.5 * guess, high = 2 * guess;
  while (high - low > 2e-3 * guess) {
    const double middle = 0.5 * (low + high);
    (stays(integrator, middle, zeta) ? low : high) = middle;
  }
  return low;
}

// The prediction is drawn over the whole map of gains; it is measured where the feedback
// is of use (and weakly damped growth is fast enough to be seen).
constexpr double least_measured = 0.099;
constexpr double most_measured = 10.01;

void measure(std::string_view integrator, double zeta, Row& row) {
  const auto predicted = stability_limit(integrator, zeta);
  if (!predicted) {
    if (stays(integrator, beyond, zeta)) return;  // no limit predicted, none found
    row.failed("unstable", "predicted to have no limit, diverged at omega h = 50");
    return;
  }
  row.set("omega_h_predicted", *predicted);
  if (zeta < least_measured || zeta > most_measured) return;
  const double measured = measured_limit(integrator, zeta, *predicted);
  row.set("omega_h_measured", measured).set("rel_gap", measured / *predicted - 1);
}

std::vector<Case> cases(const CommandLine& line) {
  const int per_decade = line.full ? 12 : 6;  // from 0.001 to 1000
  std::vector<Case> all;
  for (const std::string_view id :
       {"explicit_euler", "symplectic_euler", "velocity_verlet", "rk4",
        "semi_implicit_euler", "backward_euler", "bdf2", "implicit_midpoint"}) {
    if (!wanted(line.integrators, id)) continue;
    for (int i = 0; i <= 6 * per_decade; ++i) {
      const double zeta = 0.001 * std::pow(10, static_cast<double>(i) / per_decade);
      Row identity;
      identity.set("integrator", id).set("zeta", zeta).set("dt_s", dt);
      all.push_back(
          {identity, [id, zeta](Row& row, const auto&) { measure(id, zeta, row); }});
    }
  }
  return all;
}

void check(const std::vector<Row>& rows, Verdicts& verdicts) {
  bool any = false;
  for (const Row& row : rows) {
    if (!row.has("rel_gap")) continue;
    any = true;
    const double gap = row.number("rel_gap");
    verdicts.check(std::string(row.text("integrator")) + ", zeta " +
                       std::string(row.text("zeta")) + ": limit within 5 % of theory",
                   std::abs(gap) <= 0.05, gap);
  }
  if (!any) verdicts.not_judged("explicit methods: limit within 5 % of theory");
}

constexpr Unused unused[] = {{"models", "it is about a bead on a wire"},
                             {"elements", "it is about a bead on a wire"},
                             not_repeated,
                             not_random};

}  // namespace
}  // namespace tress

int main(int argc, char** argv) {
  using namespace tress;
  const Experiment experiment{
      .name = "baumgarte_limit",
      .question = "how large may Baumgarte's gains be, and does theory predict it?",
      .example = "--integrators symplectic_euler,rk4",
      .timed = false,
      .columns = columns,
      .unused = unused,
      .cases = cases,
      .checks = check};
  return run_experiment(experiment, argc, argv);
}
