// How wrong is a gradient, and what does it cost?
#include <algorithm>

#include "experiments/cost_of_gradient/cost_of_gradient.h"
#include "experiments/problems/strand_models.h"
#include "experiments/run/experiment.h"
#include "experiments/run/settings.h"

namespace tress::experiments::cost_of_gradient {
namespace {

constexpr Column columns[] = {
    {"part",
     "part of the study. In time, errors by steps on a curl that swings. In space, the "
     "same by elements. In contact, errors by steps of straight hair that falls on a "
     "plane. In fit, parameters of the curl fitted to the tip of a much finer run"},
    {"law", "part = contact: law of contact"},
    {"model", "catalogue id"},
    {"integrator", "method"},
    {"jacobian",
     "Jacobian of the run and of its variational equations: exact, as gradients have it, "
     "or elastic"},
    {"start",
     "damped: two short steps of backward Euler, the default of gradients; as_run: none"},
    {"elements", "number of elements"},
    {"steps", "number of steps in 0.25 s"},
    {"tip_error_rel",
     "root mean square error of the tip at ten frames, over the length; part = fit: of "
     "the fitted run"},
    {"gradient_error_rel",
     "largest of the errors of the four parameters: of the derivative of the tip at ten "
     "frames, over its size (root mean squares). In part fit, the error of the fitted "
     "value over the true one"},
    {"modulus_error_rel", "error of the derivative by Young's modulus, or of its fit"},
    {"friction_error_rel", "error of the derivative by the internal friction"},
    {"drag_error_rel", "error of the derivative by the drag"},
    {"curvature_error_rel", "error of the derivative by the natural curvature"},
    {"reference_gap", "uncertainty of the reference, as gradient_error_rel"},
    {"tip_order", "order of tip_error_rel between this row and the one before"},
    {"gradient_order", "order of gradient_error_rel"},
    {"linearizations_1_percent",
     "linearizations for a gradient_error_rel of 1 %, by the power law between rows of "
     "the same method; empty: no row is as accurate"},
    {"linearizations_001_percent", "linearizations for a gradient_error_rel of 0.01 %"},
    {"linearizations", "linearizations of the run and of its derivatives"},
    {"evaluations", "part = fit: runs with their derivatives"},
    {"time_s", "processor time of the run with four derivatives, s", true},
};

std::vector<Case> cases(const CommandLine& line) {
  const Settings settings(line, {});
  Sweep sweep = line.quick ? Sweep::quick() : Sweep::full();
  sweep.integrators = line.integrators;
  std::vector<Case> all;
  const auto add = [&](Row identity, auto rows) {
    all.push_back({std::move(identity), {}, [rows](const Row& own, const Deadline&) {
                     return rows(own);
                   }});
  };
  std::vector<std::string> chosen;
  for (const ModelEntry* model : strand_models()) {
    if (!wanted(line.models, model->id)) continue;
    chosen.emplace_back(model->id);
    Row identity;
    identity.set("part", "time").set("model", model->id);
    add(identity, [sweep](const Row& own) { return time_rows(own, sweep); });
  }
  if (wanted(line.integrators, "esdirk43")) {
    Row identity;
    identity.set("part", "space");
    add(identity,
        [sweep, chosen](const Row& own) { return space_rows(own, sweep, chosen); });
  }
  if (!wanted(line.models, "super_helix")) return all;
  Row fitted;
  fitted.set("part", "fit").set("model", "super_helix");
  add(fitted, [sweep](const Row& own) { return fit_rows(own, sweep); });
  for (const ContactLaw& law : contact_laws()) {
    const auto selected = [&](std::string_view id) {
      return wanted(line.integrators, id);
    };
    if (std::ranges::none_of(law.integrators, selected)) continue;
    Row identity;
    identity.set("part", "contact").set("law", law.name).set("model", "super_helix");
    add(identity,
        [sweep, &law](const Row& own) { return contact_rows(own, sweep, law); });
  }
  return all;
}

/// What is below its reference, diverges or has no solution is a result.
bool finding(const Row& row) {
  return row.status() == "below_reference" || row.status() == "diverged" ||
         row.status() == "solver_error";
}

constexpr Unused unused[] = {{"elements", "the study tries several"},
                             {"set", "the study sets all options"},
                             not_random,
                             not_repeated};

}  // namespace
}  // namespace tress::experiments::cost_of_gradient

int main(int argc, char** argv) {
  using namespace tress::experiments;
  using namespace tress::experiments::cost_of_gradient;
  return run_experiment(
      {.name = "cost_of_gradient",
       .question = "how wrong is a gradient, and which method gives 1 % cheapest?",
       .example = "--models super_helix,der --integrators tr_bdf2,esdirk43 --quick",
       .sizes = {"18 rows, 630 in the table, 1 min", "18 rows, more steps and elements"},
       .quick_timeout_s = 600,
       .columns = columns,
       .unused = unused,
       .cases = cases,
       .derive = compare,
       .checks = judge,
       .finding = finding},
      argc, argv);
}
