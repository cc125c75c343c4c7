// The matrices of a system at an instant, as files for other programs, and what they are.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "contract/input_error.h"
#include "experiments/matrices/system_matrices.h"
#include "experiments/problems/scene_files.h"
#include "experiments/problems/strand_models.h"
#include "experiments/run/advised.h"
#include "experiments/run/experiment.h"
#include "experiments/run/settings.h"
#include "integrators/catalogue.h"
#include "simulation/files/files.h"
#include "simulation/files/parse.h"
#include "simulation/scene_changes/changes.h"

namespace tress::experiments::matrices {
namespace {

constexpr Column columns[] = {
    {"scene", "name of the scene"},
    {"model", "model of the system"},
    {"strand", "number of the strand in the scene, from 1"},
    {"elements",
     "number of elements of the strand; 0: the model has a geometry of its own"},
    {"time_s", "instant of the motion"},
    {"step_s", "step h of S"},
    {"matrix",
     "M = dr/da; D = dr/dv; K = dr/dq; S = M + h D + h^2 K; G = dg/dq by rows; C = "
     "d(G^T lambda)/dq"},
    {"rows", "coordinates; of G constraints"},
    {"cols", "coordinates"},
    {"nonzeros", "entries in the file"},
    {"derivatives",
     "analytic, or differences of the residual (error 1e-10 of the largest entries)"},
    {"asymmetry_rel", "largest entry of A - A^T over that of A"},
    {"eigenvalue_least", "least real part; units of the model's coordinates"},
    {"eigenvalue_largest", "largest real part"},
    {"eigenvalue_imaginary", "largest imaginary part"},
    {"condition", "|A| |A^-1| in the norm of column sums; empty: singular to rounding"},
    {"frequency_least_hz",
     "lowest frequency of K: sqrt(lambda)/(2 pi), K x = lambda M x, without "
     "constraints"},
    {"frequency_largest_hz", "highest frequency of K"},
    {"file",
     "MatrixMarket file in the folder of the table; empty: the table has no file"},
};

constexpr std::string_view shipped_scenes =
    "scenes/curly_clump_oscillation.toml,scenes/palm_tree.toml,"
    "scenes/inextensible_chain.toml,scenes/tinkertoys_truss.toml";

constexpr Parameter own_settings[] = {
    {.name = "scenes",
     .help = "scene files, as in a.toml,b.toml",
     .text = true,
     .fallback = shipped_scenes},
    {.name = "time", .help = "instant (s)", .number = 0.1, .min = 0, .max = 1e6},
    {.name = "strand",
     .help = "number of the strand of a scene, from 1",
     .number = 1,
     .min = 1,
     .max = 1e6,
     .whole = true},
    {.name = "step",
     .help = "h of the step's matrix (s)",
     .number = 1.0 / 300,
     .min = 1e-12,
     .max = 1e6},
    {.name = "dense_limit",
     .help = "larger matrices are written without their spectrum, which costs O(n^3)",
     .number = 600,
     .min = 0,
     .max = 1e4,
     .whole = true},
};

constexpr OwnOption command_options[] = {
    {"scene", "scenes",
     "your own scene (several: a.toml,b.toml) instead of the built-in ones", true},
    {"time", "time", "instant of the motion (s)"},
    {"strand", "strand", "number of the strand of the scene, from 1"},
};

struct Work {
  Scene scene;
  const ModelEntry* model = nullptr;
  int elements = 0;        // asked for; 0: as the scene has them
  std::size_t strand = 0;  // from 0
  double time = 0, step = 0;
  int dense_limit = 0;
  std::string folder;  // of the files; empty: none
  std::shared_ptr<const simulation::ReadyFolder> made;
};

/// Of the strand; 0: the model has a geometry of its own.
std::size_t elements_in(const Work& work) {
  const std::vector<Strand>& strands = work.scene.strands;
  if (work.elements > 0) return static_cast<std::size_t>(work.elements);
  return work.strand < strands.size() ? strands[work.strand].segments.size() : 0;
}

std::string name_of(const Work& work) {
  const std::size_t n = elements_in(work);
  return fmt::format("{}.{}{}", work.scene.name, work.model->id,
                     n > 0 ? fmt::format(".{}", n) : "");
}

/// Returns the scene with the requested model and number of elements. Throws InputError
/// where the model does not support the scene.
Scene scene_of(const Work& work) {
  Scene scene = work.scene;
  if (work.elements > 0) scene = with_elements(std::move(scene), work.elements);
  if (scene.model == work.model) return scene;
  const IntegratorEntry& integrator = find_integrator(scene.integrator);
  return driven(std::move(scene), *work.model, integrator);
}

void set_spectrum(const Work& work, const Named& one, const Named& mass, bool free,
                  Row& row) {
  const Matrix& matrix = one.matrix;
  if (matrix.rows != matrix.cols || matrix.rows > work.dense_limit) return;
  row.set("asymmetry_rel", asymmetry(matrix));
  const Spectrum found = spectrum(matrix);
  row.set("eigenvalue_least", found.least).set("eigenvalue_largest", found.largest);
  row.set("eigenvalue_imaginary", found.imaginary).set("condition", found.condition);
  if (one.name != "K" || !free) return;
  const auto [least, largest] = frequencies_hz(mass.matrix, matrix);
  row.set("frequency_least_hz", least).set("frequency_largest_hz", largest);
}

/// The file's name, relative to the table.
std::string write(const Work& work, const Named& one) {
  if (work.folder.empty()) return "";
  const std::string file =
      fmt::format("{}/{}.{}.mtx", work.folder, name_of(work), one.name);
  const std::string comment =
      fmt::format("{}: {}; {} at {} s, {}", one.name, one.what, name_of(work), work.time,
                  one.analytic ? "analytic" : "by differences of the residual");
  simulation::replace_file(file, matrix_market(one.matrix, comment));
  return (std::filesystem::path(work.folder).filename() /
          std::filesystem::path(file).filename())
      .string();
}

/// What the files of one system are, with the state at which they hold.
void describe(const Work& work, const Moment& moment, const std::vector<Named>& all) {
  if (work.folder.empty()) return;
  nlohmann::ordered_json text{
      {"scene", work.scene.name},
      {"model", work.model->id},
      {"strand", work.strand + 1},
      {"time_s", work.time},
      {"step_s", work.step},
      {"equations", "r(t, q, v, a) - G^T lambda = 0, g(t, q) = 0; v = q', a = v'"},
      {"units", "SI: lengths in m, angles in rad, curvatures in 1/m"},
      {"q", moment.at.q},
      {"v", moment.at.v},
      {"a", moment.at.a},
      {"lambda", moment.multipliers},
      {"matrices", nlohmann::ordered_json::array()}};
  for (const Named& one : all) {
    text["matrices"].push_back(
        {{"name", one.name},
         {"what", one.what},
         {"file", fmt::format("{}.{}.mtx", name_of(work), one.name)},
         {"rows", one.matrix.rows},
         {"cols", one.matrix.cols},
         {"nonzeros", one.matrix.entries.size()},
         {"derivatives", one.analytic ? "analytic" : "differences"}});
  }
  simulation::replace_file(fmt::format("{}/{}.json", work.folder, name_of(work)),
                           text.dump(1) + "\n");
}

std::vector<Row> measure(const Work& work, const Row& identity) {
  Moment now = moment(scene_of(work), work.strand, work.time);
  const std::vector<Named> all = matrices_of(now, work.step);
  describe(work, now, all);
  std::vector<Row> rows;
  for (const Named& one : all) {
    Row& row = rows.emplace_back(identity);
    row.set("matrix", one.name);
    row.set("rows", one.matrix.rows).set("cols", one.matrix.cols);
    row.set("nonzeros", one.matrix.entries.size());
    row.set("derivatives", one.analytic ? "analytic" : "differences");
    set_spectrum(work, one, all.front(), now.multipliers.empty(), row);
    row.set("file", write(work, one));
  }
  return rows;
}

std::vector<Row> run(const Work& work, const Row& identity) {
  Row row = identity;
  try {
    return measure(work, identity);
  } catch (const InputError& refused) {
    row.failed("refused", refused.what());
  } catch (const std::runtime_error& failure) {
    row.failed("diverged", failure.what());
  }
  return {row};
}

/// Returns the chosen models, or the scene's own; for the built-in scenes of strands,
/// all models.
std::vector<const ModelEntry*> models_of(const Scene& scene, const CommandLine& line,
                                         bool ours) {
  std::vector<const ModelEntry*> chosen;
  if (scene.strands.empty() || (line.models.empty() && !ours)) {
    if (wanted(line.models, scene.model->id)) chosen.push_back(scene.model);
    return chosen;
  }
  for (const ModelEntry* model : strand_models()) {
    if (wanted(line.models, model->id)) chosen.push_back(model);
  }
  return chosen;
}

/// Returns the requested numbers of elements; 0: those of the scene. None where they
/// cannot be chosen.
std::vector<int> elements_of(const Scene& scene, const CommandLine& line, bool ours) {
  if (scene.strands.empty() && !line.elements.empty()) return {};
  if (scene.strands.empty()) return {0};
  if (!line.elements.empty()) return line.elements;
  return {ours ? 8 : 0};
}

std::vector<Case> cases(const CommandLine& line) {
  const Settings settings(line, own_settings);
  settings.leave_models_to_the_scene();
  const Parameters& own = settings.experiment();
  const bool ours = !settings.chosen("scenes");
  Work work;
  work.strand = static_cast<std::size_t>(own.whole("strand")) - 1;
  work.time = own.number("time");
  work.step = own.number("step");
  work.dense_limit = static_cast<int>(own.whole("dense_limit"));
  if (line.out != "-") work.folder = simulation::beside(line.out, "");
  if (!work.folder.empty() && !line.dry_run) {
    work.made =
        std::make_shared<simulation::ReadyFolder>(work.folder, "--out " + line.out);
  }
  std::vector<Case> all;
  const auto files = simulation::listed_files(own.word("scenes"), "scenes");
  for (const Scene& scene : simulation::read_scenes(files)) {
    work.scene = scene;
    for (const ModelEntry* model : models_of(scene, line, ours)) {
      for (const int elements : elements_of(scene, line, ours)) {
        work.model = model;
        work.elements = elements;
        Row identity;
        identity.set("scene", scene.name).set("model", model->id);
        identity.set("strand", work.strand + 1);
        identity.set("elements", elements_in(work));
        identity.set("time_s", work.time).set("step_s", work.step);
        all.push_back({identity, {}, [work](const Row& row, const Deadline&) {
                         return run(work, row);
                       }});
      }
    }
  }
  if (all.empty()) {
    throw InputError("no scene is by a model that was chosen, or has elements to choose",
                     "command line",
                     "give scenes with [strand] or [groom], or leave out --models and "
                     "--elements");
  }
  return all;
}

/// Size, condition and frequencies of each matrix.
void answer(const CommandLine& line, const std::vector<Row>& rows) {
  std::vector<std::string> lines;
  for (const Row& row : rows) {
    std::string text =
        fmt::format("{} at {:.3g} s, {}: {}: {} x {}, {} entries", row.text("scene"),
                    row.number("time_s"), row.text("model"), row.text("matrix"),
                    row.text("rows"), row.text("cols"), row.text("nonzeros"));
    if (row.has("condition")) {
      text += fmt::format(", condition {:.2g}", row.number("condition"));
    }
    if (row.has("frequency_least_hz")) {
      text += fmt::format(", frequencies {:.3g} to {:.3g} Hz",
                          row.number("frequency_least_hz"),
                          row.number("frequency_largest_hz"));
    }
    lines.push_back(row.ok() ? text
                             : fmt::format("{}: no answer: {}", row.text("scene"),
                                           row.text("reason")));
  }
  print_answer(line, lines);
}

constexpr Unused unused[] = {
    {"integrators", "the scene files set them"}, not_random, not_repeated};

}  // namespace
}  // namespace tress::experiments::matrices

int main(int argc, char** argv) {
  using namespace tress::experiments;
  using namespace tress::experiments::matrices;
  const Experiment experiment{
      .name = "matrices",
      .question =
          "what are the matrices of a system at an instant, and how are they "
          "conditioned?",
      .example = "--scene scenes/cantilever.toml --time 0.5",
      .sizes = {"15 rows, 1 s", "the same rows"},
      .timed = false,
      .columns = columns,
      .settings = own_settings,
      .options = command_options,
      .unused = unused,
      .cases = cases,
      .conclude = answer};
  return run_experiment(experiment, argc, argv);
}
