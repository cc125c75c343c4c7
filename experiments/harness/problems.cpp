#include "experiments/harness/problems.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "experiments/harness/pendulum_reference.h"
#include "experiments/harness/reference.h"
#include "models/published/references.h"

namespace tress {
namespace {

using Values = std::vector<double>;

Values coordinates(System&, const State& end) { return end.q; }

Values points(System& system, const State& end) {
  MaterialPoints& material = *system.material_points();
  Values x(3 * static_cast<std::size_t>(material.count()));
  material.positions(0, end.q, x);
  return x;
}

/// A bead of 1 m radius released horizontally: x = sin theta, z = -cos theta.
Problem bead(std::string_view name, const char* form) {
  const double t_end = 5;
  const auto exact = PendulumReference(std::sqrt(9.81), {M_PI / 2, 0}).at(t_end);
  return {.name = name,
          .model = "bead_on_wire",
          .settings = {{"form", form}},
          .t_end = t_end,
          .coarse_step = 0.02,
          .scale = 1,
          .reference = {std::sin(exact.angle), 0, -std::cos(exact.angle)},
          // GSL's elliptic functions over a handful of periods: rounding.
          .reference_gap = 1e-14,
          .compared = points};
}

Problem published(std::string_view model, double coarse_step) {
  const PublishedEnd& end = *published_end(model);
  Problem problem{.name = model,
                  .model = model,
                  .settings = {},
                  .t_end = end.t,
                  .coarse_step = coarse_step,
                  .scale = 0,
                  .reference = {end.q.begin(), end.q.end()},
                  .reference_gap = std::pow(10, -end.digits_q),
                  .compared = coordinates};
  for (const double entry : problem.reference) {
    problem.scale = std::max(problem.scale, std::abs(entry));
  }
  return problem;
}

/// One tight run; throws when it fails, because every error would then be meaningless.
Values tight_run(const Problem& problem, std::string_view integrator,
                 Formulation formulation) {
  const auto system = problem.make();
  Options options;
  options.rtol = 1e-13;
  options.atol = 1e-14;
  options.max_order = integrator == "arkode_erk" ? 8 : 0;
  options.formulation = formulation;
  const Simulation run =
      simulate(integrator, *system, options, initial_state(*system), problem.t_end);
  if (run.status != Status::ok) {
    throw std::runtime_error("reference of " + std::string(problem.name) + " by " +
                             std::string(integrator) + " failed: " + run.failure);
  }
  return problem.compared(*system, run.state);
}

/// References by an explicit Runge-Kutta method and by an Adams method.
Problem computed(Problem problem, Formulation runge_kutta, Formulation adams) {
  problem.reference = tight_run(problem, "gsl_rk8pd", runge_kutta);
  const Values second = tight_run(problem, "cvode_adams", adams);
  problem.reference_gap =
      ReferenceGap(problem.reference, second, In(&problem.scale, 1)).gap();
  return problem;
}

std::vector<Problem> make_problems() {
  std::vector<Problem> all{bead("pendulum", "parametric"),
                           bead("pendulum_constrained", "implicit")};
  all.push_back(computed({.name = "double_pendulum",
                          .model = "double_pendulum",
                          .settings = {},
                          .t_end = 2,
                          .coarse_step = 0.01,
                          .scale = 1,
                          .reference = {},
                          .reference_gap = 0,
                          .compared = coordinates},
                         Formulation::parametric, Formulation::parametric));
  all.push_back(computed({.name = "chain_10",
                          .model = "inextensible_chain",
                          .settings = {{"links", "10"}},
                          .t_end = 0.5,
                          .coarse_step = 4e-3,
                          .scale = 1,
                          .reference = {},
                          .reference_gap = 0,
                          .compared = points},
                         Formulation::projection, Formulation::acceleration));
  all.push_back(published("andrews_squeezer", 2e-4));
  all.push_back(published("slider_crank", 1e-3));
  all.push_back(published("beam", 1e-2));
  return all;
}

}  // namespace

ProblemError Problem::error(System& system, const State& end) const {
  const Values x = compared(system, end);
  return {error_norms(x, reference, In(&scale, 1)).relative, scd(x, reference)};
}

std::span<const Problem> problems() {
  static const std::vector<Problem> all = make_problems();
  return all;
}

}  // namespace tress
