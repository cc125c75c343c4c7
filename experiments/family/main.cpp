// Are the statements of the README true for one hair or for hair in general? Each is
// tested on a family of hairs drawn from measurements, and on one of rods of other
// materials.
#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "experiments/family/family.h"
#include "experiments/run/experiment.h"
#include "experiments/run/settings.h"
#include "simulation/files/csv.h"
#include "simulation/files/files.h"

namespace tress::experiments::family {
namespace {

constexpr Parameter settings[] = {
    {.name = "family",
     .help = "population: hair drawn from measured human hair, or rods of fifteen other "
             "materials",
     .choices = "all|hair|rods"},
    {.name = "hairs",
     .help = "number of hairs, 0: 48, with --full 144",
     .number = 0,
     .min = 0,
     .max = 100'000,
     .whole = true},
    {.name = "rods",
     .help = "number of rods, 0: 45, with --quick 30, with --full 135",
     .number = 0,
     .min = 0,
     .max = 100'000,
     .whole = true},
    {.name = "friction",
     .help = "internal friction: drawn, or none as a numerical check",
     .choices = "drawn|none"},
    {.name = "study",
     .help = "part of the study to run",
     .choices = "all|stable_steps|twist|bdf_order|equal_accuracy|tolerance|sweeps|"
                "tolerances"},
    {.name = "position_tol_rel",
     .help = "tolerance of the study of that name, relative to the length",
     .number = 1e-3,
     .min = 1e-8,
     .max = 0.1},
    {.name = "most_calls",
     .help = "maximum number of model evaluations of an adaptive run, 0: 4e6, with "
             "--quick 6.4e4",
     .number = 0,
     .min = 0,
     .max = 1e12},
};

std::vector<Column> columns_of_table() {
  std::vector<Column> all = {
      {"study", "study of the row"},
      {"claim", "the statement that the row tests"},
      {"family", "hair, or rods of other materials"},
      {"hair", "number of the rod in its family"},
      {"model", "model of the row, where one model is tested"},
      {"position_tol_rel", "requested tolerance over the length"},
      {"most_calls", "limit of model evaluations in an adaptive run"},
      {"integrator", "method of the row, where one method is tested"}};
  for (const Column& column : rod_columns()) all.push_back(column);
  all.insert(
      all.end(),
      {{"value", "quantity that decides the claim; family_summary.csv defines it"},
       {"holds", "whether the claim holds for this rod"},
       {"steps", "accepted steps of the adaptive run"},
       {"rejected", "rejected steps of the adaptive run"},
       {"work",
        "work of the adaptive run: model evaluations and steps, each times "
        "coordinates + 10"},
       {"wall_s", "wall time of the adaptive run", true},
       {"failure", "reason why the adaptive run has no solution"},
       {"fixed_integrator", "method with the best fixed step"},
       {"fixed_dt_s", "best fixed step: 1/60 s over a power of two"},
       {"fixed_work", "work of the run with the best fixed step"},
       {"fixed_wall_s", "wall time of the run with the best fixed step", true},
       {"elements", "number of elements of every model of the row"},
       {"reduced",
        "compared quantity of the reduced model: largest stable step (s), or "
        "elements"},
       {"maximal", "compared quantity of der: largest stable step (s), or elements"},
       {"horizon_s",
        "last time at which two independent methods agree, so that the error is up to "
        "there; empty: they agree to the end"},
       {"growth",
        "growth of a deviation of the strand into one of its tip, where an error is "
        "above the tolerance"},
       {"gap", "uncertainty of the answer, relative to the length"},
       {"error_rel", "study tolerances: tip error in time over the length"},
       {"looser_error_rel", "study tolerances: error_rel at ten times the tolerance"},
       {"warned",
        "whether the run warns of the energy that its method dissipated or created"}});
  return all;
}

int count_of(const CommandLine& line, const Parameters& own, Family family) {
  const bool hair = family == Family::hair;
  const int asked = own.whole(hair ? "hairs" : "rods");
  if (asked > 0) return asked;
  if (line.full) return hair ? 144 : 135;
  return hair ? 48 : line.quick ? 30 : 45;
}

Case case_of(const Study& study, const Rod& rod, Row identity) {
  rod.describe(identity.set("family", name(rod.family)).set("hair", rod.number));
  const auto run = study.run;
  return {identity, {}, [rod, run](const Row& row, const Deadline&) {
            return run(rod, row);
          }};
}

/// The rods of a study.
std::vector<Rod> rods_of(const CommandLine& line, const Parameters& own,
                         const Study& study) {
  std::vector<Rod> all;
  for (const Family family : {Family::hair, Family::rods}) {
    if (own.word("family") != "all" && own.word("family") != name(family)) continue;
    for (Rod& rod : latin_hypercube(family, count_of(line, own, family), line.seed)) {
      if (line.quick && (rod.number - 1) % study.quick.stride != 0) continue;
      if (own.word("friction") == "none") rod.internal_friction = 0;
      all.push_back(rod);
    }
  }
  return all;
}

double calls_of(const CommandLine& line, const Parameters& own) {
  if (own.number("most_calls") > 0) return own.number("most_calls");
  return line.quick ? 6.4e4 : 4e6;
}

void add_cases(const CommandLine& line, const Parameters& own, const Study& study,
               std::vector<Case>& all) {
  const std::vector<Rod> rods = rods_of(line, own, study);
  const auto add = [&](const Row& of_model) {
    for (const Rod& rod : rods) all.push_back(case_of(study, rod, of_model));
  };
  Row identity;
  identity.set("study", study.id);
  if (study.models.empty()) return add(identity);
  identity.set("position_tol_rel", own.number("position_tol_rel"));
  identity.set("most_calls", calls_of(line, own));
  const auto models = line.quick ? study.models.first(study.quick.models) : study.models;
  for (const std::string_view model : models) {
    if (wanted(line.models, model)) add(Row(identity).set("model", model));
  }
}

std::vector<Case> cases(const CommandLine& line) {
  const Settings checked(line, settings);
  const Parameters& own = checked.experiment();
  std::vector<Case> all;
  for (const Study& study : studies()) {
    const bool all_studies = own.word("study") == "all" && !study.apart;
    if (!all_studies && own.word("study") != study.id) continue;
    if (study.models.empty() && !line.models.empty()) continue;  // compares its own
    add_cases(line, own, study, all);
  }
  return all;
}

/// Of the study tolerances.
void check_tolerances(const std::vector<Row>& rows, Verdicts& verdicts) {
  bool judged = false, holds = true;
  double most = 0;
  for (const Row& row : rows) {
    if (row.text("study") != tolerances_study.id || !row.ok()) continue;
    judged = true;
    holds = holds && row.text("holds") == "true";
    if (row.text("warned") != "true") most = std::max(most, row.number("value"));
  }
  if (!judged) return;
  verdicts.check(std::string(tolerances_study.claims.front().statement), holds, most);
}

void write_summary(const CommandLine& line, const std::vector<Row>& rows) {
  if (line.out == "-") return;
  std::vector<std::string> names;
  for (const Column& column : summary_columns()) names.emplace_back(column.name);
  std::string csv = csv_line(names);
  for (const Row& row : summarize(rows)) csv += csv_line(in_order(row, names));
  replace_file(beside(line.out, "_summary.csv"), csv);
}

/// Studies count the rods without an answer.
bool finding(const Row& row) {
  constexpr std::array without_answer{"unresolved", "no_reference", "not_met",
                                      "sensitive",  "solver_error", "short_horizon"};
  return std::ranges::find(without_answer, row.status()) != without_answer.end();
}

constexpr Unused unused[] = {{"integrators", "each study compares its own"},
                             {"elements", "each study compares its own"},
                             not_repeated};

}  // namespace
}  // namespace tress::experiments::family

int main(int argc, char** argv) {
  using namespace tress::experiments;
  using namespace tress::experiments::family;
  const std::vector<Column> columns = family::columns_of_table();
  const Experiment experiment{
      .name = "family",
      .question = "for which hairs and rods are the statements about one hair true?",
      .example = "--set hairs=96 --set study=twist",
      .sizes = {"347 rows, 30 strands of each family, 1.6 min",
                "3627 rows, 135 strands and more, hours"},
      .timed = false,
      .quick_timeout_s = 600,  // against hangs only: steps bound the work
      .columns = columns,
      .settings = family::settings,
      .unused = family::unused,
      .cases = family::cases,
      .checks = family::check_tolerances,
      .finding = family::finding,
      .conclude = family::write_summary};
  return run_experiment(experiment, argc, argv);
}
