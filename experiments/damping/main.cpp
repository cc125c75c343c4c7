// How much energy does a method take from a hair that swings without friction?
#include <algorithm>

#include "experiments/problems/strand_models.h"
#include "experiments/problems/strand_scenes.h"
#include "experiments/run/experiment.h"
#include "experiments/run/settings.h"
#include "models/strand/strand_parameters.h"

namespace tress::experiments::damping {
namespace {

constexpr double t_end = 1;                                      // s
constexpr double usual_steps[] = {1. / 60, 1. / 240, 1. / 960};  // s
constexpr std::string_view usual_models[] = {"super_helix", "der"};
constexpr std::string_view usual_methods[] = {
    "linearly_implicit_euler", "backward_euler", "bdf2",
    "generalized_alpha",       "tr_bdf2",        "implicit_midpoint"};

constexpr Column columns[] = {
    {"model", "catalogue id"},
    {"integrator", "method"},
    {"elements", "number of elements"},
    {"dt_s", "fixed step"},
    {"energy_lost_rel",
     "energy at the start less that after a second, over what a fall to rest would free, "
     "m g L/2; below zero: gained"},
    {"steps", "steps of the run"},
};

void measure(const Parameters& p, const Options& options, Row& row) {
  const auto system = find_model(row.text("model")).make(p);
  const std::string_view method = row.text("integrator");
  const std::string no = refusal(find_integrator(method), *system, options.formulation);
  if (!no.empty()) {
    row.failed("refused", no);
    return;
  }
  const State start = initial_state(*system);
  const Simulation run = simulate(method, *system, options, start, t_end);
  row.set("steps", run.stats.steps);
  const auto energy = [&](double t, const State& s) {
    return system->energetics()->energy(t, s.q, s.v).total();
  };
  const double fall =
      strand(p).mass() * p.number("gravity_m_s2") * p.number("length_m") / 2;
  const double lost = (energy(0, start) - energy(run.t, run.state)) / fall;
  if (run.status != Status::ok) {
    row.failed("diverged", run.failure);
  } else if (!(lost >= -1)) {
    row.failed("unstable", "it gained more than a fall would free");
  } else {
    row.set("energy_lost_rel", lost);
  }
}

std::vector<Case> cases(const CommandLine& line) {
  const Settings settings(line, {});
  const auto asked = [](const auto& chosen, const auto& usual, auto id) {
    return chosen.empty() ? std::ranges::find(usual, id) != std::end(usual)
                          : wanted(chosen, id);
  };
  std::vector<Case> all;
  const auto add = [&](const ModelEntry& model, std::string_view method, int elements,
                       double step) {
    Parameters p = settings.parameters(model);
    set_known(p, find_strand_scene("release").settings);
    set_known(p, {{"elements", std::to_string(elements)}});
    Options options = settings.options();
    options.step = step;
    Row row;
    row.set("model", model.id).set("integrator", method);
    row.set("elements", elements).set("dt_s", step);
    all.push_back({row, [=](Row& r, const Deadline&) { measure(p, options, r); }});
  };
  std::vector<double> steps(std::begin(usual_steps), std::end(usual_steps));
  if (settings.chosen("step")) steps = {settings.options().step};
  std::vector<int> sizes = line.elements;
  if (sizes.empty()) sizes = {10};
  for (const ModelEntry* model : strand_models()) {
    if (!asked(line.models, usual_models, model->id)) continue;
    for (const IntegratorEntry& method : integrator_catalogue()) {
      if (method.adaptive || !asked(line.integrators, usual_methods, method.id)) continue;
      for (const int elements : sizes) {
        for (const double step : steps) add(*model, method.id, elements, step);
      }
    }
  }
  return all;
}

/// A method that diverges is a result, and so is one that a model refuses.
bool finding(const Row& row) {
  return row.status() == "diverged" || row.status() == "unstable" ||
         row.status() == "refused";
}

constexpr Unused unused[] = {not_random, not_repeated};

}  // namespace
}  // namespace tress::experiments::damping

int main(int argc, char** argv) {
  using namespace tress::experiments;
  using namespace tress::experiments::damping;
  return run_experiment(
      {.name = "damping",
       .question = "how much energy does a method take from a hair that swings freely?",
       .example = "--models der --integrators bdf2,tr_bdf2",
       .sizes = {"36 rows, 1 s", "the same rows"},
       .timed = false,
       .columns = columns,
       .unused = unused,
       .cases = cases,
       .finding = finding},
      argc, argv);
}
