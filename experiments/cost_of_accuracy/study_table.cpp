#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/cost_of_accuracy/cost_of_accuracy.h"
#include "experiments/problems/strand_models.h"
#include "integrators/integrator_options.h"
#include "simulation/files/parse.h"

namespace tress::experiments::cost_of_accuracy {
namespace {

constexpr Column table_columns[] = {
    {"scene", "name of the scene"},
    {"kind",
     "kind of the row: winner, runner_up (another model or integrator), "
     "without (one choice replaced), budget, front (Pareto) or as_given "
     "(by the scene file). Kinds by_step and by_tolerance: cheapest run "
     "of one model without and with error control. Kind method: "
     "cheapest run of one model with one integrator. Kind left_out: a model or an "
     "integrator that cannot run the scene, of an answer"},
    {"choice",
     "replaced choice, in kind without; elements: twice, dt_s: half (or the "
     "tolerance that halves the steps). radau5, rodas5p: the cheapest run with this "
     "integrator. In kind left_out: the model or the integrator"},
    {"target_error_rel", "target error"},
    {"budget_ms", "wall time allowed per frame, in kind budget"},
    {"rank", "1 winner, 2 runner-up; 1 as well where the two are tied"},
    {"model", "catalogue id"},
    {"integrator", "method"},
    {"formulation", "constraint formulation"},
    {"modes", "unknowns of an element, where there is a choice"},
    {"jacobian", "terms of the Newton matrix, where there is a choice"},
    {"solver", "linear solver, where there is a choice"},
    {"options", "other options of the model that are not the default"},
    {"refresh", "when the Newton matrix is rebuilt, if not in every iteration"},
    {"elements", "number of elements"},
    {"mesh",
     "mesh: rest (elements share the bending at rest); else the mesh of the "
     "scene file"},
    {"extrapolated",
     "whether the tip is extrapolated from these elements and half of them "
     "(Richardson)"},
    {"dt_s", "time step; empty: adaptive"},
    {"position_tol_rel",
     "requested tolerance over the length, of a run that chooses its steps"},
    {"mean_step_s", "mean step of that run"},
    {"error_rel",
     "tip against the continuous rod: rms over strands, frames after t = 0 and the end "
     "of the scene, over the length"},
    {"error_of",
     "measure of the errors. strand: largest distance along the strands, at the ends of "
     "16 equal parts of each, rms over the frames. Empty: tip. Scenes with supports or "
     "joints have the first"},
    {"error_refined_rel", "error_rel against the reference refined once more"},
    {"error_neighbours_rel",
     "largest error of its neighbours: 1 and 2 elements more, step or tolerance "
     "times 0.7 and 1.4, moduli and length 2 % up and down"},
    {"worst_neighbour", "neighbour that has this error"},
    {"margin",
     "error_neighbours_rel and reference_gap together, over the target error; at "
     "most 1.5, or the result is luck"},
    {"error_indicator",
     "method's own error estimate in its worst step, over the scale of an "
     "unknown; above 0.1 the step does not resolve the motion"},
    {"reference_gap", "distance between super_helix and der, both extrapolated"},
    {"refined_gap", "reference_gap of the references refined once more"},
    {"horizon_s", "compared time: the requested time, or until the references part"},
    {"horizon_cut", "whether the references parted before the end"},
    {"asked_s", "time that was to be compared: duration_s, or horizon_s of --set"},
    {"duration_s", "duration of the scene"},
    {"parted_rel", "rms distance of the references from there on, over the length"},
    {"references", "models of the references of your own scene, and their resolution"},
    {"wall_s_per_sim_s",
     "wall time per simulated second on one thread, nothing else running", true},
    {"ms_per_frame", "wall time per frame", true},
    {"cost_per_step_s", "wall time per step, in kind method", true},
    {"length_error_rel",
     "largest relative change of an element's length, in kind method"},
    {"linear_error_rel",
     "largest change of linear momentum over m g 0.1 s, in kind method, thrown "
     "strands"},
    {"angular_error_rel",
     "largest change of angular momentum over its initial value, in kind method, "
     "thrown strands"},
    {"energy_error_rel",
     "largest change of mechanical energy over the largest kinetic energy, in "
     "kind method"},
    {"unknowns", "coordinates and multipliers, in kind method"},
    {"nonzeros",
     "entries of the matrix of a step; unknowns squared where the matrix is dense"},
    {"cost_factor", "wall time over the winner's; of kind by_tolerance over by_step's",
     true},
    {"time_scatter",
     "scatter of the wall time: ratio of the two halves of its repeats, less 1", true},
    {"exhaustive_gain",
     "time of the search's winner over that of the cheapest run of a grid of "
     "every method; empty: not requested (exhaustive)",
     true},
    {"tied", "whether the time cannot be distinguished from that of the winner", true},
    {"runs", "runs that the search took", true},
    {"work", "million elements x steps of all of them", true},
    {"passed_over", "cheaper runs left out because their neighbours miss a target", true},
    {"search",
     "whole: every method was tried wherever it costs less than the winner; cut: the "
     "search used up its work before",
     true},
};

constexpr std::string_view own_columns[] = {"modes", "jacobian", "solver"};

}  // namespace

std::span<const Column> study_columns() { return table_columns; }

void set_method(const Method& method, Row& row) {
  row.set("model", method.model->id).set("integrator", method.integrator);
  row.set("formulation", name(method.formulation));
  std::string others;
  for (const auto& [key, value] : method.options) {
    if (std::ranges::count(own_columns, key) > 0) continue;
    others += fmt::format("{}{}={}", others.empty() ? "" : ",", key, value);
  }
  if (method.refresh != Refresh::every_iteration) {
    Options options;
    options.refresh = method.refresh;
    row.set("refresh", integrators::text_of(options, "refresh"));
  }
  if (method.cut_at_rest) row.set("mesh", "rest");
  if (method.extrapolated) row.set("extrapolated", true);
  for (const std::string_view choice : own_columns) {
    if (!method.word(choice).empty()) row.set(choice, method.word(choice));
  }
  if (!others.empty()) row.set("options", others);
}

Configuration configuration(const Row& row) {
  Configuration made;
  made.method.model = &find_model(row.text("model"));
  made.method.integrator = std::string(row.text("integrator"));
  for (int i = 0; i <= static_cast<int>(Formulation::correction); ++i) {
    const auto one = static_cast<Formulation>(i);
    if (name(one) == row.text("formulation")) made.method.formulation = one;
  }
  for (const std::string_view key : own_columns) {
    const std::string_view first = first_word(*made.method.model, key);
    if (row.has(key) && row.text(key) != first) {
      made.method.options.emplace_back(key, row.text(key));
    }
  }
  if (row.has("options")) {
    for (const std::string& one : split(row.text("options"), ',', "options")) {
      const std::size_t equals = one.find('=');
      made.method.options.emplace_back(one.substr(0, equals), one.substr(equals + 1));
    }
  }
  made.elements = static_cast<int>(row.number("elements"));
  if (row.has("refresh")) {
    Options options;
    integrators::apply(options, "refresh", row.text("refresh"), "refresh");
    made.method.refresh = options.refresh;
  }
  made.method.cut_at_rest = row.text("mesh") == "rest";
  made.method.extrapolated = row.text("extrapolated") == "true";
  made.method.by_tolerance = row.has("position_tol_rel");
  made.accuracy = made.method.by_tolerance
                      ? Accuracy{.tolerance = row.number("position_tol_rel")}
                      : Accuracy{.step = row.number("dt_s")};
  return made;
}

}  // namespace tress::experiments::cost_of_accuracy
