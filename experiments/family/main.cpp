// Do the statements of the README hold for one hair or for hair in general? Each is
// tested on a family of hairs over length, thickness, stiffness, section, curl, friction
// and drive.
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
    {.name = "hairs",
     .help = "members of the family, 0: 48, with --full 144",
     .number = 0,
     .min = 0,
     .max = 100'000,
     .whole = true},
    {.name = "study",
     .help = "rows of one piece of work",
     .choices = "all|stable_steps|twist|bdf_order|equal_accuracy|tolerance|sweeps"},
    {.name = "tolerance",
     .help = "asked for by the study of that name, over the length",
     .number = 1e-3,
     .min = 1e-8,
     .max = 0.1},
    {.name = "most_calls",
     .help = "of the model in a run by tolerance, 0: 4e6, with --quick 6.4e4",
     .number = 0,
     .min = 0,
     .max = 1e12},
};

std::vector<Column> columns_of_table() {
  std::vector<Column> all = {{"study", "the piece of work"},
                             {"claim", "the statement that the row tests"},
                             {"hair", "number of the hair in the family"},
                             {"model", "where one model is tested"},
                             {"tolerance", "error asked for, over the length"},
                             {"most_calls", "of the model in a run by tolerance"},
                             {"integrator", "where one method is tested"}};
  for (const Column& column : hair_columns()) all.push_back(column);
  all.insert(
      all.end(),
      {{"value", "what decides; family_summary.csv says what it is"},
       {"holds", "whether the claim holds for this hair"},
       {"steps", "of the run by tolerance, rejected ones apart"},
       {"rejected", "its steps that were repeated"},
       {"work", "its calls of the model and steps, each times coordinates + 10"},
       {"wall_s", "its time", true},
       {"failure", "why it has no solution"},
       {"fixed_integrator", "the method with the best fixed step"},
       {"fixed_dt_s", "that step, of 1/60 s and its halves"},
       {"fixed_work", "its work"},
       {"fixed_wall_s", "its time", true},
       {"elements", "of all models of the row"},
       {"reduced",
        "what value compares, of the model of reduced coordinates: the "
        "largest stable step (s), or elements"},
       {"maximal", "the same of der"},
       {"horizon_s",
        "last time at which two independent methods agree, so that the error is up to "
        "there; empty: they agree to the end"},
       {"growth",
        "of a deviation of the strand to that of its tip, where an error is beyond "
        "the tolerance"},
       {"gap", "what the answer is uncertain by, relative to the length"}});
  return all;
}

int count_of(const CommandLine& line, const Parameters& own) {
  if (own.whole("hairs") > 0) return own.whole("hairs");
  return line.full ? 144 : 48;
}

Case case_of(const Study& study, const Hair& hair, Row identity) {
  hair.describe(identity);
  const auto run = study.run;
  return {identity, {}, [hair, run](const Row& row, const Deadline&) {
            return run(hair, row);
          }};
}

/// The hairs of a study.
std::vector<Hair> hairs_of(const CommandLine& line, const Parameters& own,
                           const Study& study) {
  std::vector<Hair> all = latin_hypercube(count_of(line, own), line.seed);
  if (line.quick) {
    std::erase_if(all, [&](const Hair& hair) {
      return (hair.number - 1) % study.quick.stride != 0;
    });
  }
  return all;
}

double calls_of(const CommandLine& line, const Parameters& own) {
  if (own.number("most_calls") > 0) return own.number("most_calls");
  return line.quick ? 6.4e4 : 4e6;
}

void add_cases(const CommandLine& line, const Parameters& own, const Study& study,
               std::vector<Case>& all) {
  const std::vector<Hair> hairs = hairs_of(line, own, study);
  const auto add = [&](const Row& of_model) {
    for (const Hair& hair : hairs) {
      Row identity = of_model;
      all.push_back(case_of(study, hair, identity.set("hair", hair.number)));
    }
  };
  Row identity;
  identity.set("study", study.id);
  if (study.models.empty()) return add(identity);
  identity.set("tolerance", own.number("tolerance"));
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
    if (own.word("study") != "all" && own.word("study") != study.id) continue;
    if (study.models.empty() && !line.models.empty()) continue;  // compares its own
    add_cases(line, own, study, all);
  }
  return all;
}

void write_summary(const CommandLine& line, const std::vector<Row>& rows) {
  if (line.out == "-") return;
  std::vector<std::string> names;
  for (const Column& column : summary_columns()) names.emplace_back(column.name);
  std::string csv = csv_line(names);
  for (const Row& row : summarize(rows)) csv += csv_line(in_order(row, names));
  replace_file(beside(line.out, "_summary.csv"), csv);
}

/// Studies count the hairs without an answer.
bool finding(const Row& row) {
  constexpr std::array without_answer{"unresolved", "no_reference", "not_met",
                                      "sensitive", "solver_error"};
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
      .question = "for which hairs do the statements about one hair hold?",
      .example = "--set hairs=96 --set study=twist",
      .timed = false,
      .quick_timeout_s = 600,  // against hangs only: steps bound the work
      .columns = columns,
      .settings = family::settings,
      .unused = family::unused,
      .cases = family::cases,
      .finding = family::finding,
      .conclude = family::write_summary};
  return run_experiment(experiment, argc, argv);
}
