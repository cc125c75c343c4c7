#include "experiments/problems/problems.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "contract/forms/material_points.h"
#include "experiments/problems/pendulum_reference.h"
#include "experiments/problems/reference.h"
#include "models/published/references.h"

namespace tress::experiments {
namespace {

using Values = std::vector<double>;

Values points_of(System& system, In q) {
  MaterialPoints& material = *system.material_points();
  Values x(3 * static_cast<std::size_t>(material.count()));
  material.positions(0, q, x);
  return x;
}

/// The values that a reference has; all of them before there is one.
Values compared_values(const Problem& problem, System& system, const State& state) {
  if (problem.compared == Compared::points) return points_of(system, state.q);
  if (problem.compared == Compared::velocities) return state.v;
  Values q = state.q;
  const std::size_t known = problem.reference.back().values.size();
  if (known > 0) q.resize(known);
  return q;
}

double distance(In x, std::size_t i, In y, std::size_t j) {
  return std::hypot(x[3 * i] - y[3 * j], x[3 * i + 1] - y[3 * j + 1],
                    x[3 * i + 2] - y[3 * j + 2]);
}

/// The longest way along a body.
double length_of(const MaterialPoints& body, In x) {
  Values way(x.size() / 3);
  for (std::size_t i = 0; i < way.size(); ++i) {
    const int before = body.before(static_cast<int>(i));
    if (before < 0) continue;
    const auto j = static_cast<std::size_t>(before);
    way[i] = way[j] + distance(x, i, x, j);
  }
  return std::ranges::max(way);
}

/// Of an error over the scale of the problem: entries of a first-order state can be zero.
double digits(double relative) {
  return std::isfinite(relative) ? -std::log10(relative)
                                 : -std::numeric_limits<double>::infinity();
}

double body_error(const Problem& problem, System& system, const State& state,
                  In reference) {
  const MaterialPoints* const body = system.material_points();
  const Values x = body == nullptr ? Values{} : points_of(system, state.q);
  const double length = body == nullptr ? 0 : length_of(*body, x);
  if (length == 0) {
    if (problem.compared == Compared::points) {
      return error_norms(x, reference, problem.scale).relative;
    }
    Values q_typ(state.q.size()), v_typ(q_typ.size());
    system.scale(q_typ, v_typ);
    Values& typical = problem.compared == Compared::velocities ? v_typ : q_typ;
    typical.resize(reference.size());
    return error_norms(compared_values(problem, system, state), reference, typical)
        .relative;
  }
  const Values y = problem.compared == Compared::points
                       ? Values(reference.begin(), reference.end())
                       : points_of(system, reference);
  double largest = 0;
  for (std::size_t i = 0; i < x.size() / 3; ++i) {
    largest = std::max(largest, distance(x, i, y, i));
  }
  return largest / length;
}

/// A bead of 1 m radius released horizontally: x = sin theta, z = -cos theta.
Problem bead(std::string_view name, const char* form) {
  Problem problem{.name = name,
                  .model = "bead_on_wire",
                  .settings = {{"form", form}},
                  .t_end = 5,
                  .coarse_step = 0.02,
                  .scale = {1},
                  .reference = checkpoints(5, 10),
                  // Error of GSL's elliptic functions over a few periods: rounding.
                  .reference_gap = 1e-14,
                  .compared = Compared::points};
  const PendulumReference exact(std::sqrt(9.81), {M_PI / 2, 0});
  for (Checkpoint& at : problem.reference) {
    const double angle = exact.at(at.t).angle;
    at.values = {std::sin(angle), 0, -std::cos(angle)};
  }
  return problem;
}

/// The end state printed by the Test Set; every angle on its own scale, as in its scd.
Problem published(std::string_view model, double coarse_step) {
  const PublishedEnd& end = *published_end(model);
  Problem problem{.name = model,
                  .model = model,
                  .settings = {},
                  .t_end = end.t,
                  .coarse_step = coarse_step,
                  .scale = {end.q.begin(), end.q.end()},
                  .reference = {{end.t, {end.q.begin(), end.q.end()}}},
                  .reference_gap = std::pow(10, -end.digits_q),
                  .compared = Compared::coordinates};
  for (double& entry : problem.scale) entry = std::abs(entry);
  return problem;
}

/// The values at every checkpoint of one tight run; throws if it fails, because every
/// error would then be meaningless.
std::vector<Checkpoint> tight_run(const Problem& problem, std::string_view integrator,
                                  Formulation formulation) {
  const auto system = problem.make();
  Options options;
  options.rtol = 1e-13;
  options.atol = 1e-14;
  options.formulation = formulation;
  std::vector<Checkpoint> values = problem.reference;
  std::size_t next = 0;
  std::vector<double> stops(values.size());
  std::ranges::transform(values, stops.begin(), &Checkpoint::t);
  const Simulation run = simulate(integrator, *system, options, initial_state(*system),
                                  stops, [&](const State& state) {
                                    values[next++].values =
                                        compared_values(problem, *system, state);
                                  });
  if (run.status != Status::ok) {
    throw std::runtime_error("reference of " + std::string(problem.name) + " by " +
                             std::string(integrator) + " failed: " + run.failure);
  }
  return values;
}

std::vector<Problem> make_problems() {
  std::vector<Problem> all{bead("pendulum", "parametric"),
                           bead("pendulum_constrained", "implicit")};
  const auto add = [&all](std::string_view name, std::string_view model,
                          const ModelSettings& settings, double t_end, double coarse_step,
                          const std::vector<double>& scale, int stops, Compared compared,
                          Formulation runge_kutta, Formulation adams) {
    all.push_back(computed({.name = name,
                            .model = model,
                            .settings = settings,
                            .t_end = t_end,
                            .coarse_step = coarse_step,
                            .scale = scale,
                            .reference = checkpoints(t_end, stops),
                            .reference_gap = 0,
                            .compared = compared},
                           runge_kutta, adams));
  };
  add("double_pendulum", "double_pendulum", {}, 2, 0.01, {1}, 5, Compared::coordinates,
      Formulation::parametric, Formulation::parametric);
  add("chain_10", "inextensible_chain", {{"links", "10"}}, 0.5, 4e-3, {1}, 5,
      Compared::points, Formulation::projection, Formulation::acceleration);
  all.push_back(published("andrews_squeezer", 2e-4));
  // The printed end state has five digits (tests/models/published): our own has more.
  // Each coordinate on its own scale: the elastic modes are of micrometres, unlike the
  // crank's turns.
  add("slider_crank", "slider_crank", {}, 0.1, 1e-3, {}, 1, Compared::coordinates,
      Formulation::projection, Formulation::acceleration);
  all.push_back(published("car_axis", 1e-2));
  all.push_back(published("beam", 1e-2));
  all.push_back(published("wheelset", 2e-3));
  add("filament", "filament", {}, 0.01, 5e-4, {1}, 1, Compared::velocities,
      Formulation::parametric, Formulation::parametric);
  return all;
}

}  // namespace

std::vector<double> points(System& system, const State& state) {
  return points_of(system, state.q);
}

std::unique_ptr<System> Problem::make() const { return make_model(model, settings); }

std::vector<Checkpoint> checkpoints(double t_end, int count) {
  std::vector<Checkpoint> times(static_cast<std::size_t>(count));
  for (int k = 1; k <= count; ++k)
    times[static_cast<std::size_t>(k - 1)].t = t_end * k / count;
  return times;
}

Problem computed(Problem problem, Formulation runge_kutta, Formulation adams) {
  const auto second = tight_run(problem, "cvode_adams", adams);
  problem.reference = tight_run(problem, "gsl_rk8pd", runge_kutta);
  if (problem.scale.empty()) {
    for (const double entry : problem.reference.back().values) {
      problem.scale.push_back(std::abs(entry));
    }
  }
  for (std::size_t k = 0; k < second.size(); ++k) {
    const ReferenceGap gap(problem.reference[k].values, second[k].values, problem.scale);
    problem.reference_gap = std::max(problem.reference_gap, gap.gap());
  }
  return problem;
}

ProblemRun run_problem(const Problem& problem, std::string_view integrator,
                       const Options& options) {
  const auto system = problem.make();
  ProblemError error{0, 16, 0};
  std::size_t next = 0;
  std::vector<double> stops;
  for (const Checkpoint& at : problem.reference) stops.push_back(at.t);
  Simulation end = simulate(
      integrator, *system, options, initial_state(*system), stops,
      [&](const State& state) {
        const Values x = compared_values(problem, *system, state);
        const Values& reference = problem.reference[next++].values;
        const double relative = error_norms(x, reference, problem.scale).relative;
        // NaN counts as the largest error.
        error.relative = relative <= error.relative ? error.relative : relative;
        error.scd = std::min(error.scd, problem.compared == Compared::velocities
                                            ? digits(relative)
                                            : scd(x, reference));
        error.of_body =
            std::max(error.of_body, body_error(problem, *system, state, reference));
      });
  return {std::move(end), error};
}

std::span<const Problem> problems() {
  static const std::vector<Problem> all = make_problems();
  return all;
}

}  // namespace tress::experiments
