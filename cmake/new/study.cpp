// FILL IN: the question that this study answers?
#include <algorithm>

#include "contract/fill_in.h"
#include "experiments/problems/strand_models.h"
#include "experiments/problems/strand_scenes.h"
#include "experiments/run/experiment.h"
#include "experiments/run/settings.h"

namespace tress::experiments::skeleton_name {
namespace {

constexpr double t_end = 0.1;  // s
constexpr std::string_view usual_models[] = {"super_helix", "der"};
constexpr std::string_view usual_methods[] = {"backward_euler", "tr_bdf2"};

/// FILL IN: what stands in a row, with the unit in the name.
constexpr Column columns[] = {
    {"model", "catalogue id"},
    {"integrator", "method"},
    {"elements", "number of elements"},
    {"steps", "number of steps"},
};

/// Fills one row, in a process of its own.
void measure(const Parameters& p, const Options& options, Row& row) {
  const auto system = find_model(row.text("model")).make(p);
  const std::string_view method = row.text("integrator");
  const std::string no = refusal(find_integrator(method), *system, options.formulation);
  if (!no.empty()) {
    row.failed("refused", no);
    return;
  }
  const Simulation run =
      simulate(method, *system, options, initial_state(*system), t_end);
  if (run.status != Status::ok) {
    row.failed("diverged", run.failure);
    return;
  }
  row.set("steps", run.stats.steps);
  fill_in("what is measured in a run: run.state, system->energetics(), ...");
}

template <class Usual>
bool selected(const std::vector<std::string>& chosen, const Usual& usual,
              std::string_view id) {
  return chosen.empty() ? std::ranges::find(usual, id) != std::end(usual)
                        : wanted(chosen, id);
}

/// FILL IN: the rows, each with what identifies it and the function that measures it.
std::vector<Case> cases(const CommandLine& line) {
  const Settings settings(line, {});
  const std::vector<int> sizes =
      line.elements.empty() ? std::vector<int>{10} : line.elements;
  std::vector<Case> all;
  const auto add = [&](const ModelEntry& model, std::string_view method, int elements) {
    Parameters p = settings.parameters(model);
    set_known(p, find_strand_scene("release").settings);
    set_known(p, {{"elements", std::to_string(elements)}});
    Row row;
    row.set("model", model.id).set("integrator", method).set("elements", elements);
    all.push_back({row, [p, options = settings.options()](Row& r, const Deadline&) {
                     measure(p, options, r);
                   }});
  };
  for (const ModelEntry* model : strand_models()) {
    if (!selected(line.models, usual_models, model->id)) continue;
    for (const IntegratorEntry& method : integrator_catalogue()) {
      if (!selected(line.integrators, usual_methods, method.id)) continue;
      for (const int elements : sizes) add(*model, method.id, elements);
    }
  }
  return all;
}

/// A method that diverges is a result, and so is one that a model refuses.
bool finding(const Row& row) {
  return row.status() == "diverged" || row.status() == "refused";
}

/// FILL IN: the shared options that the study ignores, with the reason.
constexpr Unused unused[] = {not_random, not_repeated};

}  // namespace
}  // namespace tress::experiments::skeleton_name

int main(int argc, char** argv) {
  using namespace tress::experiments;
  using namespace tress::experiments::skeleton_name;
  return run_experiment({.name = "skeleton_name",
                         .question = "FILL IN: the question",
                         .example = "--models der --integrators tr_bdf2",
                         .timed = false,
                         .columns = columns,
                         .unused = unused,
                         .cases = cases,
                         .finding = finding},
                        argc, argv);
}
