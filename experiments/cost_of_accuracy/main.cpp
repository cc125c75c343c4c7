// For a given scene and target error: what is the cheapest configuration? And what is the
// best accuracy within a given time per frame? With the cost of every choice.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include "contract/input_error.h"
#include "experiments/cost_of_accuracy/cost_of_accuracy.h"
#include "experiments/run/advised.h"
#include "experiments/run/experiment.h"
#include "experiments/run/machine.h"
#include "experiments/run/settings.h"
#include "simulation/files/parse.h"

namespace tress::experiments::cost_of_accuracy {
namespace {

constexpr Parameter own_settings[] = {
    {.name = "scenes",
     .help = "scene files, as in scenes/a.toml,scenes/b.toml",
     .text = true,
     .fallback = "scenes/cantilever.toml,scenes/curly_clump_oscillation.toml,"
                 "scenes/accuracy/fall_on_sphere.toml,scenes/accuracy/"
                 "shaken_friction.toml,scenes/accuracy/side_wind.toml,"
                 "scenes/accuracy/swing.toml,scenes/accuracy/whip.toml"},
    {.name = "each_method",
     .help = "scene files of one strand: the cheapest run within 0.01 of the length, "
             "with its errors, by every model and usual integrator. Left out where "
             "scenes are given",
     .text = true,
     .fallback = "scenes/accuracy/release.toml,scenes/accuracy/flight.toml"},
    {.name = "advise",
     .help =
         "scene file: recommend the cheapest model, integrator and step for the whole "
         "scene, and write the tuned scene",
     .text = true},
    {.name = "answer_s",
     .help = "wall time for the answer, with advise (s)",
     .number = 100,
     .min = 1,
     .max = 1e6},
    {.name = "accuracy",
     .help = "target error over the length, 0: the usual list; with advise 0.01",
     .number = 0,
     .min = 0,
     .max = 1},
    {.name = "budget_ms",
     .help = "available wall time per frame (ms); 0: no limit",
     .number = 0,
     .min = 0,
     .max = 1e6},
    {.name = "fps",
     .help = "frames per second (1/s)",
     .number = 60,
     .min = 1,
     .max = 1e4},
    {.name = "horizon_s",
     .help =
         "time that is compared, at most the scene's (s); 0: all of it, of the scenes "
         "of the published table 0.5",
     .number = 0,
     .min = 0,
     .max = 1e3},
    {.name = "strands",
     .help = "typical strands of a groom that are compared, 0: 1, with advise 3",
     .number = 0,
     .min = 0,
     .max = 1e4,
     .whole = true},
    {.name = "control",
     .help = "models, as in super_helix,der, on which methods with error control are "
             "compared with those with fixed steps only. Each model adds a search of the "
             "same length",
     .text = true},
    {.name = "mesh",
     .help = "given: the elements of each scene; both: also elements that share the "
             "bending of a strand at rest",
     .choices = "given|both"},
    {.name = "search_work",
     .help =
         "work of one scene's search, million elements x steps of all runs; 0: 5 with "
         "--quick, 15 with advise, else 60",
     .number = 0,
     .min = 0,
     .max = 1e6},
    {.name = "exhaustive",
     .help = "test of the search: every method is tried with all elements of the ladder "
             "and 1 to 64 steps a frame, half an octave apart",
     .choices = "no|yes"},
    {.name = "reference_elements",
     .help =
         "elements of the finest run of a reference, doubled where it is refined again",
     .number = 160,
     .min = 4,
     .max = 1e4,
     .whole = true},
    {.name = "reference_substeps",
     .help = "steps per frame of the finest run of a reference",
     .number = 64,
     .min = 2,
     .max = 1e6,
     .whole = true},
    {.name = "references",
     .help = "folder of the references; empty: results/reference, for own scenes "
             "<table>.reference next to the table",
     .text = true},
};

constexpr OwnOption command_options[] = {
    {"scene", "scenes", "your own scene (several: a.toml,b.toml)", true},
    {"advise", "advise",
     "scene file: prints what to take, next best and what not to do; writes "
     "<scene>.advised.toml next to --out",
     true},
    {"budget", "budget_ms",
     "best accuracy within this time per frame, ms (--set fps=30: 30 frames a second)"},
};

constexpr double usual_targets[] = {0.03, 0.01, 0.001, 1e-4};
constexpr double quick_targets[] = {0.03, 0.01, 0.001};
constexpr double advised_target = 0.01;
constexpr double published_horizon = 0.5;  // s

/// What an answer tries: the models and methods that ever win a row of the published
/// table, so that the time is enough for a whole search.
void narrow(MethodChoice& methods) {
  if (methods.models.empty()) {
    methods.models = {"super_helix", "super_clothoid", "articulated_chain",
                      "der",         "mass_spring",    "dynamic_spline"};
  }
  if (methods.integrators.empty()) {
    methods.integrators = {"linearly_implicit_euler",
                           "implicit_midpoint",
                           "linearly_implicit_midpoint",
                           "bdf2",
                           "tr_bdf2",
                           "esdirk43"};
  }
  methods.refreshes = {Refresh::every_step};
  methods.options = {"modes", "jacobian=elastic", "torsion"};
  // A file holds one run.
  methods.extrapolated = false;
}

/// References of own scenes must not replace those of the published table.
std::string reference_folder(const CommandLine& line, const Parameters& own,
                             bool published) {
  if (!own.word("references").empty()) return std::string(own.word("references"));
  if (published) return "results/reference";
  if (line.out == "-") return "";
  return std::filesystem::path(line.out).replace_extension(".reference").string();
}

StudyPlan plan_of(const CommandLine& line, const Settings& settings) {
  const Parameters& own = settings.experiment();
  StudyPlan plan;
  plan.advise = !own.word("advise").empty();
  const bool published = !plan.advise && !settings.chosen("scenes");
  const double accuracy = own.number("accuracy");
  if (accuracy > 0) {
    plan.targets = {accuracy};
  } else if (!own.word("advise").empty()) {
    plan.targets = {advised_target};
  } else if (line.quick) {
    plan.targets.assign(std::begin(quick_targets), std::end(quick_targets));
  } else {
    plan.targets.assign(std::begin(usual_targets), std::end(usual_targets));
  }
  plan.elements = {3, 4, 6, 9, 13, 19, 28, 42, 63};
  plan.substeps = {1, 2, 4, 8, 16, 32, 64, 128};
  plan.methods.models = line.models;
  if (!own.word("control").empty() && own.word("advise").empty()) {
    plan.control = split(own.word("control"), ',', "control");
    for (const std::string& id : plan.control) static_cast<void>(find_model(id));
  }
  plan.methods.integrators = line.integrators;
  plan.methods.cuts_at_rest = own.word("mesh") == "both";
  if (line.quick) {
    if (line.models.empty()) {
      plan.methods.models = {"super_helix", "articulated_chain", "der", "mass_spring",
                             "dynamic_spline"};
    }
    if (line.integrators.empty()) {
      plan.methods.integrators = {"linearly_implicit_euler", "implicit_midpoint",
                                  "linearly_implicit_midpoint", "tr_bdf2", "esdirk43"};
      if (!plan.advise) {
        plan.methods.plain.assign(std::begin(always_shown), std::end(always_shown));
      }
    }
    plan.methods.refreshes = {Refresh::every_step};
    plan.methods.fixed_steps = false;
    // Without torsion mass_spring does not preserve the direction of curls.
    plan.methods.options = {"modes", "jacobian=elastic", "torsion"};
  }
  if (plan.advise) narrow(plan.methods);
  if (!line.elements.empty()) plan.elements = line.elements;
  plan.references = reference_folder(line, own, published);
  plan.reference = {own.whole("reference_elements"), own.whole("reference_substeps")};
  plan.rate = own.number("fps");
  plan.horizon = own.number("horizon_s");
  if (plan.horizon == 0 && published) plan.horizon = published_horizon;
  plan.answer_s = own.number("answer_s");
  plan.strands = static_cast<std::size_t>(own.whole("strands"));
  if (plan.strands == 0) plan.strands = plan.advise ? 3 : 1;
  plan.search_work = 1e6 * own.number("search_work");
  if (plan.search_work == 0) {
    plan.search_work = line.quick ? 5e6 : plan.advise ? 1.5e7 : 6e7;
  }
  plan.longest_run = line.quick ? 2048 : 8192;
  plan.exhaustive = own.word("exhaustive") == "yes";
  plan.budget_s = 1e-3 * own.number("budget_ms");
  plan.repeat = line.repeat;
  // Advice does not wait for a check of the reference.
  plan.refine = !plan.advise;
  plan.report = line.progress == ProgressMode::automatic;
  return plan;
}

std::vector<std::string> scenes_of(const Parameters& own) {
  if (!own.word("advise").empty()) return {std::string(own.word("advise"))};
  return listed_files(own.word("scenes"), "scenes");
}

std::vector<std::string> method_scenes_of(const Settings& settings) {
  const Parameters& own = settings.experiment();
  const bool others = !own.word("advise").empty() || settings.chosen("scenes");
  if (others && !settings.chosen("each_method")) return {};
  if (own.word("each_method").empty()) return {};
  return split(own.word("each_method"), ',', "each_method");
}

std::vector<Case> cases(const CommandLine& line) {
  const Settings settings(line, own_settings);
  if (!settings.experiment().word("advise").empty() && settings.chosen("scenes")) {
    throw InputError("--advise with --scene", "--scene", "give one of them");
  }
  const StudyPlan plan = plan_of(line, settings);
  std::vector<Case> all;
  std::set<std::string> names;
  for (const std::string& file : scenes_of(settings.experiment())) {
    const Scene given = read_open_scene(file);
    if (!plan.advise && held(given)) {
      throw InputError(
          "supports or joints in a table of several targets, whose references do not "
          "hold them",
          file, "use --advise " + file);
    }
    if (!names.insert(given.name).second) {
      throw InputError("two scenes of one name", file, "rename one of them");
    }
    Row identity;
    identity.set("scene", given.name);
    all.push_back({identity, {}, [file, plan](const Row& row, const Deadline& deadline) {
                     return study_scene(file, plan, row, deadline);
                   }});
  }
  for (const std::string& file : method_scenes_of(settings)) {
    std::ranges::move(method_cases(line, file), std::back_inserter(all));
  }
  return all;
}

void check_claims(const std::vector<Row>& rows, Verdicts& verdicts) {
  check_accuracy_claims(rows, verdicts);
  check_method_claims(rows, verdicts);
}

/// An insufficiently known rod, or the absence of an alternative, is a valid result.
bool finding(const Row& row) {
  return row.text("kind") == "method" || row.text("kind") == "left_out" ||
         row.status() == "below_reference" || row.status() == "not_met" ||
         row.text("kind") == "as_given";
}

void advise(const CommandLine& line, const std::vector<Row>& rows) {
  const Settings settings(line, own_settings);
  const Parameters& own = settings.experiment();
  const std::string file(own.word("advise"));
  if (file.empty()) {
    print_answer(line, answers(rows));
    return;
  }
  std::vector<std::string> lines = advice(rows);
  if (const auto doubt = timing_doubt()) lines.push_back(*doubt);
  lines.push_back("table: " + line.out);
  print_advice(lines);
  const Row* best = advised(rows);
  if (!may_be_written(rows) || line.out == "-") return;
  const Scene given = read_open_scene(file);
  const double rate =
      comparison(given, own.number("fps"), own.number("horizon_s"), 1).rate;
  write_advised("cost_of_accuracy", line, given.name, advised_text(given, *best, rate));
}

constexpr Unused unused[] = {not_random};

}  // namespace
}  // namespace tress::experiments::cost_of_accuracy

int main(int argc, char** argv) {
  using namespace tress::experiments;
  using namespace tress::experiments::cost_of_accuracy;
  const Experiment experiment{
      .name = "cost_of_accuracy",
      .question =
          "for this scene and this target error: what is the cheapest "
          "configuration?",
      .example = "--advise scenes/cantilever.toml --set accuracy=0.01",
      .sizes = {"99 rows, 3 targets, 7 min",
                "132 rows, 5 targets and longer searches, hours"},
      .quick_timeout_s = 600,
      .columns = study_columns(),
      .settings = own_settings,
      .options = command_options,
      .unused = unused,
      .cases = cases,
      .checks = check_claims,
      .finding = finding,
      .conclude = advise};
  return run_experiment(experiment, argc, argv);
}
