#include "experiments/validation/free_flight.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "contract/input_error.h"
#include "experiments/numerics/drift_monitor.h"
#include "experiments/problems/formulations.h"
#include "experiments/problems/strand_models.h"
#include "integrators/catalogue.h"

namespace tress::experiments::validation {
namespace {

constexpr double flight_time = 0.5;  // s: three quarters of a turn
constexpr double energy_bound = 10;  // times the initial energy: diverged
constexpr double most_work = 6e7;    // per row

Parameters thrown(const Settings& settings, const ModelEntry& model, int elements) {
  Parameters p = settings.parameters(model);
  p.set("motion", "free");
  p.set("gravity_m_s2", "0");
  p.set("elements", std::to_string(elements));
  return p;
}

/// Adaptive methods without the tangent resolve the stretching waves of a hair, of
/// microseconds.
bool flies(const IntegratorEntry& entry, const CommandLine& line) {
  if (!line.integrators.empty()) return wanted(line.integrators, entry.id);
  return line.full || !entry.adaptive || entry.tangent;
}

struct Flight {
  const ModelEntry* model;
  std::string_view integrator;
  Options options;
  Parameters parameters;
};

void fly(const Flight& flight, Row& row) {
  const auto system = flight.model->make(flight.parameters);
  const State start = initial_state(*system);
  Energetics& energetics = *system->energetics();
  MomentumDrift momentum(energetics, start.q, start.v);
  const double energy = energetics.energy(0, start.q, start.v).total();
  double total = energy;
  const Simulation run = simulate(flight.integrator, *system, flight.options, start,
                                  flight_time, [&](double t, In q, In v) {
                                    momentum.see(t, q, v);
                                    total = energetics.energy(t, q, v).total();
                                    return std::abs(total) <= energy_bound * energy;
                                  });
  row.set("t_end_s", run.t).set("steps", run.stats.steps);
  if (!(std::abs(total) <= energy_bound * energy)) {
    row.failed("diverged", "energy beyond ten times that of the start");
    return;
  }
  if (run.status != Status::ok) {
    row.failed("solver_error", run.failure);
    return;
  }
  row.set("linear_error_rel", momentum.linear() / momentum.linear_start());
  row.set("angular_error_rel", momentum.angular() / momentum.angular_start());
  row.set("angular_change_rel", momentum.angular_now() / momentum.angular_start() - 1);
  row.set("energy_change_rel", total / energy - 1);
}

/// Rows of one model by one integrator, over its steps or tolerances.
void add_flights(const CommandLine& line, const IntegratorEntry& entry, Flight flight,
                 std::vector<Case>& all) {
  const int levels = line.full ? 5 : line.quick ? 2 : 3;
  for (int level = 0; level < levels; ++level) {
    Row row;
    row.set("test", free_flight).set("model", flight.model->id);
    row.set("elements", flight.parameters.whole("elements"));
    row.set("integrator", entry.id);
    Options& options = flight.options;
    if (entry.adaptive) {
      options.rtol = options.atol = std::pow(10, -3 - 2 * level);
      row.set("rtol", options.rtol);
    } else {
      options.step = 1 / 120.0 / std::pow(10, level);
      row.set("dt_s", options.step);
    }
    all.push_back(
        {row, [flight](Row& of_case, const Deadline&) { fly(flight, of_case); }});
  }
}

/// Claim that the angular momentum changes as `holds` requires in all fixed-step rows
/// that `speaks_of` selects and that finish, at least one; the worst is the last in their
/// order.
template <typename SpeaksOf, typename Holds, typename Order>
void check_change(const std::string& claim, const std::vector<Row>& rows,
                  SpeaksOf speaks_of, Holds holds, Order order, Verdicts& verdicts) {
  bool run = false;
  std::vector<double> changes;
  for (const Row& row : rows) {
    if (row.text("test") != free_flight || !row.has("dt_s") || !speaks_of(row)) continue;
    run = true;
    if (row.ok()) changes.push_back(row.number("angular_error_rel"));
  }
  if (!run) return verdicts.not_judged(claim);
  const double worst =
      changes.empty() ? std::nan("") : *std::ranges::max_element(changes, order);
  verdicts.check(claim, holds(worst), worst);
}

}  // namespace

std::vector<Case> free_flight_cases(const CommandLine& line, const Settings& settings) {
  if (!settings.experiment().numbers("parameters").empty()) {
    throw InputError("free_flight has no parameter", "--set parameters",
                     "leave it out, or name other tests");
  }
  const std::vector<int> counts =
      line.elements.empty() ? std::vector<int>{10} : line.elements;
  std::vector<Case> all;
  for (const ModelEntry* model : strand_models()) {
    if (!has_word(*model, "motion", "free") || !wanted(line.models, model->id)) continue;
    for (const int elements : counts) {
      const Parameters p = thrown(settings, *model, elements);
      const auto system = model->make(p);
      for (const IntegratorEntry& entry : integrator_catalogue()) {
        const auto formulations = usable_formulations(entry, *system);
        if (!flies(entry, line) || formulations.empty()) continue;
        Options options = settings.options();
        if (!line.full && options.max_work == 0) options.max_work = most_work;
        options.formulation = formulations.front();
        add_flights(line, entry, {model, entry.id, options, p}, all);
      }
    }
  }
  return all;
}

Gloss free_flight_gloss() {
  return {
      "test",
      free_flight,
      {{"what", "thrown in space without gravity, spinning: what integrators change"},
       {"source", "no force acts: momentum, angular momentum and energy are constant"},
       {"parameter", "the step, or the tolerance of an adaptive method"},
       {"quantity", "relative change of the three over 0.5 s"},
       {"why", "nothing is asked of a model: the integrator makes the error"}}};
}

void check_free_flight(const std::vector<Row>& rows, Verdicts& verdicts) {
  check_change(
      "backward_euler at 1/120 s changes angular momentum by over 1 %", rows,
      [](const Row& row) {
        return row.number("dt_s") > 5e-3 && row.text("integrator") == "backward_euler";
      },
      [](double least) { return least > 0.01; }, std::greater{}, verdicts);
  // For particles only: der's kinetic energy omits the spin of sections (der.cpp).
  check_change(
      "implicit_midpoint keeps that of mass_spring to 1e-9", rows,
      [](const Row& row) {
        return row.text("integrator") == "implicit_midpoint" &&
               row.text("model") == "mass_spring";
      },
      [](double most) { return most < 1e-9; }, std::less{}, verdicts);
}

}  // namespace tress::experiments::validation
