// Which model by which integrator survives which hard case, and at which step? Each case
// has a reason why it is hard, and a physical criterion that a correct answer meets.
#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "experiments/hard_cases/hard_cases.h"
#include "experiments/run/advised.h"
#include "experiments/run/experiment.h"

namespace tress::experiments::hard_cases {
namespace {

constexpr Column columns[] = {
    {"case", "name of the situation, or of the scene"},
    {"model", "catalogue id"},
    {"variant", "model's choices: Jacobian, length formulation, structure"},
    {"integrator", "method"},
    {"dt_s", "time step, or the longest one with a tolerance"},
    {"position_tol_rel",
     "requested tolerance over the length; empty: all steps are dt_s"},
    {"formulation", "constraint formulation, where there are constraints"},
    {"outcome", "refused, not finished, unstable, stable, stable and accurate"},
    {"measure_name",
     "quantity that the criterion limits; empty: the guard of a scene, or a step"},
    {"measure", "largest value of that quantity in the run"},
    {"limit", "largest measure that passes"},
    {"criterion", "criterion in words, and the reason"},
    {"passed", "stable, at least"},
    {"error_rel", "error of the tip, root mean square over the horizon, over the length"},
    {"error_limit", "largest error_rel of an accurate run"},
    {"reference_gap", "error_rel of the reference at twice its step"},
    {"why", "reason for the outcome: what was refused, what became unstable and when"},
    {"t_s", "time simulated"},
    {"steps", "steps done"},
    {"newton_iterations", "Newton iterations, summed over the run"},
    {"replaced_steps",
     "steps that are backward Euler steps, of guarded and guarded_esdirk43"},
    {"wall_s", "wall time of the run, and of its reference in the row that made it",
     true},
};

/// Work limit of a row, including that of the reference that it computes for all rows of
/// its case and model.
struct Budget {
  WorkLimit row, reference;
  double patience;  // s, for a reference computed by another row
};

Budget budget_of(const CommandLine& line) {
  const double times = line.quick ? 1 : 120;
  return {{times * quick_row.most}, {times * quick_reference.most}, 0.6 * line.timeout_s};
}

void measure(const Cell& cell, References& references, const Budget& budget,
             double coarser, Row& row) {
  const HardCase& hard = *cell.attempt.hard;
  row.set("measure_name", hard.measure);
  row.set("limit", hard.limit).set("criterion", hard.criterion);
  row.set("error_limit", largest_error);
  const Survival s = survive(cell.attempt, budget.row, [&] {
    return references.get(cell.reference, budget.patience, [&] {
      return reference(hard, cell.compared, cell.attempt.defaults, cell.attempt.options,
                       coarser, budget.reference);
    });
  });
  set_survival(s, row);
}

std::vector<Case> cases(const CommandLine& line) {
  const Settings settings(line, hard_case_settings());
  if (!settings.experiment().word("scenes").empty()) return scene_cells(line, settings);
  const Grid grid = hard_grid(line, settings);
  const auto references = std::make_shared<References>(grid.references);
  const Budget budget = budget_of(line);
  const double coarser = line.quick ? 2 : 1;
  std::vector<Case> all;
  for (const Cell& cell : grid.cells) {
    all.push_back(
        {cell.identity(), [cell, references, budget, coarser](Row& row, const Deadline&) {
           measure(cell, *references, budget, coarser, row);
         }});
  }
  return all;
}

/// Marks rows that were killed or crashed.
void fill(std::vector<Row>& rows) {
  for (Row& row : rows) {
    if (!row.text("outcome").empty()) continue;
    const bool late = row.status() == "timeout";
    row.set("outcome", name(late ? Outcome::not_finished : Outcome::unstable));
    row.set("passed", false).set("why", row.text("reason"));
  }
}

std::vector<Gloss> glossary() {
  std::vector<Gloss> all;
  for (const HardCase& hard : hard_case_catalogue()) {
    all.push_back(
        {"case", hard.name, {{"hard_because", hard.why}, {"criterion", hard.criterion}}});
  }
  return all;
}

void answer(const CommandLine& line, const std::vector<Row>& rows) {
  print_answer(line, hard_answer(rows));
}

/// Failures to survive are the expected results.
bool finding(const Row& row) { return row.status() != "crashed"; }

constexpr OwnOption command_options[] = {
    {"scene", "scenes", "your own scene (several: a.toml,b.toml) instead of our cases",
     true},
};

constexpr Unused unused[] = {
    {"elements", "each case sets its number of elements"}, not_repeated, not_random};

}  // namespace
}  // namespace tress::experiments::hard_cases

int main(int argc, char** argv) {
  using namespace tress::experiments;
  using namespace tress::experiments::hard_cases;
  const Experiment experiment{
      .name = "hard_cases",
      .question =
          "which model by which integrator survives which hard case, at which "
          "step?",
      .example = "--models super_helix,der --set case=violent_shake",
      .sizes = {"3570 rows, 6 min", "57999 rows, days"},
      .timed = false,
      .quick_timeout_s = 120,  // an emergency limit: work bounds a row
      .columns = columns,
      .settings = hard_case_settings(),
      .options = command_options,
      .unused = unused,
      .cases = cases,
      .derive = fill,
      .checks = check_hard_cases,
      .glossary = glossary,
      .finding = finding,
      .conclude = answer};
  return run_experiment(experiment, argc, argv);
}
