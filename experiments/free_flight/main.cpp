// What does an integrator do to momentum and energy that no force changes? A hair thrown
// in space without gravity, spinning, by every strand model whose root can be free.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "experiments/numerics/momentum_drift.h"
#include "experiments/problems/formulations.h"
#include "experiments/problems/strand_models.h"
#include "experiments/run/experiment.h"
#include "experiments/run/settings.h"
#include "integrators/catalogue.h"

namespace tress {
namespace {

constexpr Column columns[] = {
    {"model", "catalogue id"},
    {"integrator", "method"},
    {"elements", "number of elements"},
    {"dt_s", "fixed step"},
    {"rtol", "relative and absolute tolerance, adaptive methods"},
    {"t_end_s", "length of the flight"},
    {"linear_error_rel",
     "largest change of linear momentum over the flight, over itself"},
    {"angular_error_rel", "the same of angular momentum about the origin"},
    {"angular_change_rel", "change of its size from start to end"},
    {"energy_change_rel", "change of mechanical energy from start to end, over it"},
    {"steps", "accepted steps"},
};

constexpr double t_end = 0.5;        // s: three quarters of a turn
constexpr double energy_bound = 10;  // times the start's: diverged
constexpr double most_work = 6e7;    // of a row

Parameters thrown(const Settings& settings, const ModelEntry& model, int elements) {
  Parameters p = settings.parameters(model);
  p.set("root", "free");
  p.set("gravity_m_s2", "0");
  p.set("elements", std::to_string(elements));
  return p;
}

/// Adaptive methods without the tangent follow the waves of stretching of a hair,
/// microseconds long.
bool shown(const IntegratorEntry& entry, const CommandLine& line) {
  if (!line.integrators.empty()) return wanted(line.integrators, entry.id);
  return line.full || !entry.adaptive || entry.tangent;
}

struct Work {
  const ModelEntry* model;
  std::string_view integrator;
  Options options;
  Parameters parameters;
};

void measure(const Work& work, Row& row) {
  const auto system = work.model->make(work.parameters);
  const State start = initial_state(*system);
  Energetics& energetics = *system->energetics();
  MomentumDrift momentum(energetics, start.q, start.v);
  const double energy = energetics.energy(0, start.q, start.v).total();
  double total = energy;
  const Simulation run = simulate(work.integrator, *system, work.options, start, t_end,
                                  [&](double t, In q, In v) {
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

std::vector<Case> cases(const CommandLine& line) {
  const Settings settings(line, {});
  const std::vector<int> counts =
      line.elements.empty() ? std::vector<int>{10} : line.elements;
  std::vector<Case> all;
  for (const ModelEntry* model : strand_models()) {
    if (!has_word(*model, "root", "free") || !wanted(line.models, model->id)) continue;
    for (const int elements : counts) {
      const Parameters p = thrown(settings, *model, elements);
      const auto system = model->make(p);
      for (const IntegratorEntry& entry : integrators()) {
        if (!shown(entry, line)) continue;
        Options options = settings.options();
        if (!line.full && options.max_work == 0) options.max_work = most_work;
        const auto formulations = usable_formulations(entry, *system);
        if (formulations.empty()) continue;
        options.formulation = formulations.front();
        const int points = line.full ? 5 : line.quick ? 2 : 3;
        for (int level = 0; level < points; ++level) {
          Row identity;
          identity.set("model", model->id).set("integrator", entry.id);
          identity.set("elements", elements);
          if (entry.adaptive) {
            options.rtol = options.atol = std::pow(10, -3 - 2 * level);
            identity.set("rtol", options.rtol);
          } else {
            options.step = 1 / 120.0 / std::pow(10, level);
            identity.set("dt_s", options.step);
          }
          const Work work{model, entry.id, options, p};
          all.push_back(
              {identity, [work](Row& row, const auto&) { measure(work, row); }});
        }
      }
    }
  }
  return all;
}

/// The angular momentum lost by the rows that `speaks_of` picks: the least and the most.
struct Lost {
  double least = INFINITY, most = -INFINITY;
  int run = 0, finished = 0;
};

template <typename SpeaksOf>
Lost lost(const std::vector<Row>& rows, SpeaksOf speaks_of) {
  Lost found;
  for (const Row& row : rows) {
    if (!row.has("dt_s") || !speaks_of(row)) continue;
    ++found.run;
    if (!row.ok()) continue;
    ++found.finished;
    const double error = row.number("angular_error_rel");
    found.least = std::min(found.least, error);
    found.most = std::max(found.most, error);
  }
  return found;
}

void check(const std::vector<Row>& rows, Verdicts& verdicts) {
  const auto judge = [&](const std::string& claim, const Lost& of, bool held,
                         double value) {
    if (of.run == 0) {
      verdicts.not_judged(claim);
    } else {
      verdicts.check(claim, of.finished > 0 && held, value);
    }
  };
  const Lost damped = lost(rows, [](const Row& row) {
    return row.number("dt_s") > 5e-3 && row.text("integrator") == "backward_euler";
  });
  judge("backward_euler at 1/120 s changes angular momentum by over 1 %", damped,
        damped.least > 0.01, damped.least);
  const Lost kept = lost(rows, [](const Row& row) {
    return row.text("integrator") == "implicit_midpoint" &&
           row.text("model") == "mass_spring";
  });
  // Of particles alone: der's kinetic energy does not keep the spin of sections (der.h).
  judge("implicit_midpoint keeps that of mass_spring to 1e-9", kept, kept.most < 1e-9,
        kept.most);
}

/// An explicit step too large for a hair is a finding.
bool finding(const Row&) { return true; }

constexpr Unused unused[] = {not_repeated, not_random};

}  // namespace
}  // namespace tress

int main(int argc, char** argv) {
  using namespace tress;
  const Experiment experiment{
      .name = "free_flight",
      .question = "what do integrators do to momentum and energy that no force changes?",
      .example = "--models der --integrators backward_euler,implicit_midpoint",
      .timed = false,
      .columns = columns,
      .unused = unused,
      .cases = cases,
      .checks = check,
      .finding = finding};
  return run_experiment(experiment, argc, argv);
}
