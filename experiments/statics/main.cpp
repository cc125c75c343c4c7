// Equilibria of a strand along one parameter, and where they lose stability.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "contract/input_error.h"
#include "experiments/problems/strand_models.h"
#include "experiments/run/advised.h"
#include "experiments/run/experiment.h"
#include "experiments/run/settings.h"
#include "experiments/statics/equilibrium_path.h"
#include "experiments/statics/path_picture.h"
#include "experiments/statics/path_rows.h"
#include "experiments/statics/path_words.h"
#include "experiments/statics/static_claims.h"
#include "simulation/files/files.h"
#include "simulation/files/parse.h"
#include "simulation/scene_changes/changes.h"

namespace tress::experiments::statics {
namespace {

constexpr std::string_view shipped_scenes =
    "experiments/statics/deep_arch.toml,experiments/statics/column.toml";

/// The shipped scenes have forces of EI/L^2 or EI/R^2.
constexpr std::string_view shipped_range = "point_force=0..10";

constexpr Parameter own_settings[] = {
    {.name = "scenes",
     .help = "scene files, as in a.toml,b.toml",
     .text = true,
     .fallback = shipped_scenes},
    {.name = "over",
     .help =
         "parameter of the path and its range, as in point_force=0..2. `gravity` and "
         "`point_force` (`point_force_2`: the second one) are factors on the loads of "
         "the scene. `supports` is the time of their keyframes (s). Numbers of the "
         "scene have the names of [gradient], as in youngs_modulus_pa=1e9..3e9. "
         "Without it: supports that move, else the point force, else gravity",
     .text = true},
    {.name = "strand",
     .help = "number of the strand in the scene, from 1",
     .number = 1,
     .min = 1,
     .max = 1e6,
     .whole = true},
    {.name = "resolution",
     .help = "largest distance of two points: of the parameter over its range, and of a "
             "place over the length of the strand",
     .number = 0.04,
     .min = 1e-4,
     .max = 0.5},
    {.name = "points",
     .help = "largest number of points of a path",
     .number = 400,
     .min = 2,
     .max = 1e5,
     .whole = true},
    {.name = "limit_points",
     .help = "number of limit points after which a path ends; 0: at the end of its range",
     .number = 0,
     .min = 0,
     .max = 1e3,
     .whole = true},
    {.name = "branch",
     .help = "bifurcation at which the path leaves along the other branch, from 1; "
             "negative: to its other side; 0: none",
     .number = 0,
     .min = -1e3,
     .max = 1e3,
     .whole = true},
};

constexpr OwnOption command_options[] = {
    {"scene", "scenes",
     "your own scene (several: a.toml,b.toml) instead of the built-in ones", true},
    {"over", "over", "parameter and range, as in gravity, point_force=0..2, supports"},
    {"strand", "strand", "number of the strand of the scene, from 1"},
    {"branch", "branch", "bifurcation at which the path takes the other branch, from 1"},
};

struct Work {
  Scene scene;
  std::size_t strand = 0;  // from 0
  Varied varied;
  PathOptions options;
  std::string folder;  // of the pictures; empty: none
  std::shared_ptr<const simulation::ReadyFolder> made;
};

std::size_t elements_in(const Work& work) {
  return work.scene.strands.at(work.strand).segments.size();
}

std::string title_of(const Work& work) {
  return fmt::format("{}: {}, {} elements, over {}", work.scene.name,
                     work.scene.model->id, elements_in(work), work.varied.name);
}

void draw(const Work& work, const std::vector<PathPoint>& path, const Gauge& gauge) {
  if (work.folder.empty()) return;
  const std::string stem = fmt::format("{}/{}.{}.{}", work.folder, work.scene.name,
                                       work.scene.model->id, elements_in(work));
  simulation::replace_file(stem + ".svg",
                           path_picture(path, gauge, work.varied, title_of(work)));
  simulation::replace_file(stem + ".shapes.csv", shapes_csv(path));
}

std::vector<Row> run(const Work& work, const Row& identity, const Deadline& deadline) {
  Row row = identity;
  try {
    StaticStrand strand(work.scene, work.strand, work.varied);
    PathOptions options = work.options;
    options.over = [&deadline] { return deadline.passed(); };
    const std::vector<PathPoint> path = equilibrium_path(strand, options);
    const Gauge read = gauge(strand);
    draw(work, path, read);
    return path_rows(path, read, work.varied, identity);
  } catch (const InputError& refused) {
    row.failed("refused", refused.what());
  } catch (const std::runtime_error& failure) {
    row.failed("diverged", failure.what());
  }
  return {row};
}

/// The scene by another model, with the same modes where possible.
Scene by_model(Scene scene, const ModelEntry& model) {
  if (scene.model == &model) return scene;
  ModelSettings options;
  if (scene.model_options.knows("modes")) {
    const std::string modes(scene.model_options.word("modes"));
    if (has_word(model, "modes", modes)) options.emplace_back("modes", modes);
  }
  return with_method(std::move(scene), {&model, options, scene.integrator, {}});
}

std::vector<const ModelEntry*> models_of(const Scene& scene, const CommandLine& line) {
  if (line.models.empty()) return {scene.model};
  for (const std::string& id : line.models) {
    refuse_if(find_model(id).on_strand == nullptr,
              fmt::format("model {} has a geometry of its own and no strand", id),
              line.place("models"), "give a model of a strand, such as super_helix");
  }
  std::vector<const ModelEntry*> chosen;
  for (const ModelEntry* model : strand_models()) {
    if (wanted(line.models, model->id)) chosen.push_back(model);
  }
  return chosen;
}

/// Refuses a scene without this strand.
void check_strand(const Scene& scene, const Work& work, const std::string& place) {
  refuse_if(
      scene.strands.empty(),
      fmt::format("model {} has a geometry of its own and no strand", scene.model->id),
      scene.name + ".toml",
      "give a scene with [strand] and a model of a strand, such as super_helix");
  refuse_if(work.strand >= scene.strands.size(),
            fmt::format("the scene has no strand {}", work.strand + 1), place,
            fmt::format("give a number of 1 to {}", scene.strands.size()));
}

std::string place_of_setting(const CommandLine& line, const std::string& key) {
  const auto found = line.places.find("set:" + key);
  return found == line.places.end() ? "--" + key : found->second;
}

Case case_of(const Work& work) {
  Row identity;
  identity.set("scene", work.scene.name).set("model", work.scene.model->id);
  identity.set("strand", work.strand + 1).set("elements", elements_in(work));
  identity.set("over", work.varied.name);
  return {identity, {}, [work](const Row& row, const Deadline& deadline) {
            return run(work, row, deadline);
          }};
}

std::vector<Case> cases(const CommandLine& line) {
  const Settings settings(line, own_settings);
  settings.leave_models_to_the_scene();
  const Parameters& own = settings.experiment();
  Work work;
  work.strand = static_cast<std::size_t>(own.whole("strand")) - 1;
  work.options.resolution = own.number("resolution");
  work.options.points = own.whole("points");
  work.options.limit_points = own.whole("limit_points");
  work.options.branch = own.whole("branch");
  if (line.out != "-") work.folder = simulation::beside(line.out, "");
  if (!work.folder.empty() && !line.dry_run) {
    work.made =
        std::make_shared<simulation::ReadyFolder>(work.folder, "--out " + line.out);
  }
  const bool ours = !settings.chosen("scenes") && !settings.chosen("over");
  const std::string over(ours ? shipped_range : own.word("over"));
  std::vector<Case> all;
  const auto files = simulation::listed_files(own.word("scenes"), "scenes");
  for (const Scene& scene : simulation::read_scenes(files)) {
    check_strand(scene, work, place_of_setting(line, "strand"));
    for (const ModelEntry* model : models_of(scene, line)) {
      for (const int elements : line.elements.empty() ? std::vector{0} : line.elements) {
        work.scene = by_model(scene, *model);
        if (elements > 0) work.scene = with_elements(work.scene, elements);
        work.varied = varied(work.scene, over, place_of_setting(line, "over"));
        // Of the user's scene, a refusal is the answer.
        if (settings.chosen("scenes")) {
          static_cast<void>(StaticStrand(work.scene, work.strand, work.varied));
        }
        all.push_back(case_of(work));
      }
    }
  }
  return all;
}

void answer(const CommandLine& line, const std::vector<Row>& rows) {
  std::vector<std::string> lines = in_words(rows);
  if (line.out != "-") {
    lines.push_back(
        fmt::format("pictures and shapes: {}", simulation::beside(line.out, "")));
  }
  print_answer(line, std::move(lines));
}

constexpr Unused unused[] = {
    {"integrators", "nothing moves in it"}, not_random, not_repeated};

}  // namespace
}  // namespace tress::experiments::statics

int main(int argc, char** argv) {
  using namespace tress::experiments;
  using namespace tress::experiments::statics;
  const Experiment experiment{
      .name = "statics",
      .question =
          "which equilibria does a strand have along one parameter, and where do "
          "they lose stability?",
      .example = "--scene scenes/cantilever.toml --over gravity=0..2",
      .sizes = {"2 rows, 1 s", "the same rows"},
      .timed = false,
      .columns = path_columns(),
      .settings = own_settings,
      .options = command_options,
      .unused = unused,
      .cases = cases,
      .checks = judge,
      .conclude = answer};
  return run_experiment(experiment, argc, argv);
}
