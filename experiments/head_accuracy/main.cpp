// Of a head of hair: how many hairs must be simulated, the others following them, at how
// many elements and which step, for a wanted error of all hairs? Or within a time?
#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "contract/input_error.h"
#include "experiments/head_accuracy/grooms.h"
#include "experiments/head_accuracy/head_accuracy.h"
#include "experiments/run/advised.h"
#include "experiments/run/settings.h"
#include "simulation/files/parse.h"
#include "simulation/scene/strand_tables.h"

namespace tress::experiments::head_accuracy {
namespace {

constexpr Parameter own_settings[] = {
    {.name = "scenes",
     .help = "scene files of grooms that run as batches, as in "
             "scenes/a.toml,scenes/b.toml; left "
             "out where grooms are given",
     .text = true,
     .fallback = "scenes/full_head.toml"},
    {.name = "grooms",
     .help = "grooms of the study, as in curly_varied_shaken,straight_alike_released: "
             "straight, wavy or curly; equal or varied hairs; released or shaken. "
             "Default: all, or none where scenes are given",
     .text = true,
     .fallback = "usual"},
    {.name = "accuracy",
     .help = "target error over the length of each hair, 0: 0.03 and 0.01",
     .number = 0,
     .min = 0,
     .max = 1},
    {.name = "over",
     .help = "bounded error: that of 95 of 100 hairs, the mean or the largest",
     .choices = "p95|mean|largest"},
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
     .help = "time that is compared, at most the scene's (s)",
     .number = 0.5,
     .min = 1e-3,
     .max = 1e3},
    {.name = "hairs",
     .help =
         "number of hairs compared; larger grooms are thinned; 0: 5000, for the study's "
         "grooms 1000, with --quick 300 and 128",
     .number = 0,
     .min = 0,
     .max = 10000,
     .whole = true},
    {.name = "threads",
     .help = "threads that share the hairs",
     .number = 1,
     .min = 1,
     .max = 1024,
     .whole = true},
    {.name = "reference_elements",
     .help = "elements of the finest run of the reference; 0: 32",
     .number = 0,
     .min = 0,
     .max = 1000,
     .whole = true},
    {.name = "reference_substeps",
     .help = "steps per frame of the finest run of the reference; 0: 32, with --quick 24",
     .number = 0,
     .min = 0,
     .max = 1e5,
     .whole = true},
};

constexpr OwnOption command_options[] = {
    {"scene", "scenes", "your own scene (several: a.toml,b.toml)", true},
    {"budget", "budget_ms",
     "best accuracy within this time per frame, ms (--set fps=30: 30 frames a second)"},
};

StudyPlan plan_of(const CommandLine& line, const Parameters& own) {
  StudyPlan plan;
  const double accuracy = own.number("accuracy");
  plan.targets = accuracy > 0 ? std::vector{accuracy} : std::vector{0.03, 0.01};
  plan.over = own.word("over") == "mean"  ? Over::mean
              : own.word("over") == "p95" ? Over::p95
                                          : Over::largest;
  plan.budget_s = 1e-3 * own.number("budget_ms");
  plan.comparison.rate = own.number("fps");
  plan.comparison.horizon = own.number("horizon_s");
  plan.comparison.threads = own.whole("threads");
  const auto fine = [&](const char* key, int least) {
    const int given = own.whole(key);
    return given > 0 ? given : line.quick ? least : 32;
  };
  plan.comparison.elements = fine("reference_elements", 32);
  plan.comparison.substeps = fine("reference_substeps", 24);
  for (const auto& [value, key] : {std::pair{plan.comparison.elements, "elements"},
                                   {plan.comparison.substeps, "substeps"}}) {
    if (value >= 8) continue;
    throw InputError(fmt::format("a reference of {} {}", value, key),
                     fmt::format("--set reference_{}", key), "give 8 or more");
  }
  plan.search.elements = {2, 3, 4, 5, 6, 8, 10, 12, 15, 18, 22, 26};
  plan.search.substeps = {1, 2, 3, 4, 6, 8, 12, 16};
  plan.search.sample = line.quick ? 32 : 64;
  if (line.quick) {
    plan.search.elements = {2, 3, 4, 6, 8, 12, 16};
    plan.search.substeps = {1, 2, 4, 8};
  }
  return plan;
}

std::vector<std::string> scenes_of(const Settings& settings) {
  const std::string files(settings.experiment().word("scenes"));
  const bool others = settings.chosen("grooms") && !settings.chosen("scenes");
  if (files.empty() || others) return {};
  return listed_files(files, "scenes");
}

std::vector<std::string> grooms_of(const Settings& settings) {
  const std::string chosen(settings.experiment().word("grooms"));
  if (chosen != "usual") return split(chosen, ',', "grooms");
  if (settings.chosen("scenes")) return {};
  return groom_names();
}

std::vector<Case> cases(const CommandLine& line) {
  const Settings settings(line, own_settings);
  const auto hairs = static_cast<std::size_t>(settings.experiment().whole("hairs"));
  StudyPlan plan = plan_of(line, settings.experiment());
  std::vector<Case> all;
  std::set<std::string> names;
  const auto add = [&](const std::string& name, const std::string& where,
                       const Scene& given) {
    if (!names.insert(name).second) {
      throw InputError("two scenes of one name", where, "rename one of them");
    }
    Row identity;
    identity.set("scene", name);
    all.push_back({identity, {}, [given, plan](const Row& row, const Deadline& deadline) {
                     return study_head(given, plan, row, deadline);
                   }});
  };
  plan.comparison.hairs = hairs > 0 ? hairs : line.quick ? 300 : 5000;
  const std::size_t looked_at = plan.comparison.hairs,
                    fine = static_cast<std::size_t>(plan.comparison.elements);
  if (looked_at * fine > held_at_once.elements) {
    throw InputError(
        fmt::format("{} hairs of {} elements", looked_at, fine), "--set hairs",
        fmt::format("give at most {} elements in all: hairs times reference_elements",
                    held_at_once.elements));
  }
  for (const std::string& file : scenes_of(settings)) {
    const Scene given = read_head_scene(file);
    add(given.name, file, given);
  }
  for (const std::string& name : grooms_of(settings)) {
    const std::size_t count = hairs > 0 ? hairs : line.quick ? 128 : 1000;
    add(name, "--set grooms", parse_scene(groom_text(name, count), name + ".toml"));
  }
  return all;
}

/// The answers, and of each scene that was given the first one as a scene.
void conclude(const CommandLine& line, const std::vector<Row>& rows) {
  if (line.out == "-") return;
  const Settings settings(line, own_settings);
  if (!settings.chosen("scenes")) return;
  print_advice(advice(rows));
  for (const std::string& file : scenes_of(settings)) {
    const Scene given = read_head_scene(file);
    const auto best = std::ranges::find_if(rows, [&](const Row& row) {
      const std::string_view kind = row.text("kind");
      return row.ok() && row.text("scene") == given.name &&
             (kind == "cheapest" || kind == "budget");
    });
    if (best == rows.end()) continue;
    const std::string text = advised_text(given, *best);
    if (!text.empty()) write_advised("head_accuracy", line, given.name, text);
  }
}

/// A target that is out of reach is a valid result.
bool finding(const Row& row) {
  return row.status() == "not_met" || row.status() == "below_reference" ||
         (row.status() == "failed" && row.text("kind") != "cheapest");
}

constexpr Unused unused[] = {{"models", "the scene files set them"},
                             {"integrators", "the scene files set them"},
                             {"elements", "the search finds the number needed"},
                             {"repeat", "the frames of a run are its repetitions"},
                             {"seed", "the scene files set them"}};

}  // namespace
}  // namespace tress::experiments::head_accuracy

int main(int argc, char** argv) {
  using namespace tress::experiments;
  using namespace tress::experiments::head_accuracy;
  const Experiment experiment{
      .name = "head_accuracy",
      .question =
          "which share of a groom must be simulated, and how finely, for a target error "
          "of "
          "all hairs?",
      .example = "--scene scenes/full_head.toml --set accuracy=0.01 --budget 16",
      .sizes = {"13 rows, fewer hairs, 20 s", "13 rows, 5000 hairs"},
      .quick_timeout_s = 600,
      .columns = head_columns(),
      .settings = own_settings,
      .options = command_options,
      .unused = unused,
      .cases = cases,
      .checks = check_claims,
      .finding = finding,
      .conclude = conclude};
  return run_experiment(experiment, argc, argv);
}
