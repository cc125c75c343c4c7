// Which effects of a scene change the result, by how much, and what does each cost?
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "contract/decimal.h"
#include "contract/input_error.h"
#include "experiments/effect_audit/verdict.h"
#include "experiments/run/advised.h"
#include "experiments/run/experiment.h"
#include "experiments/run/settings.h"
#include "simulation/files/parse.h"
#include "simulation/run/numbers.h"
#include "simulation/run/tip_paths.h"
#include "simulation/scene/strand_tables.h"
#include "simulation/scene_changes/changes.h"

namespace tress::experiments::effect_audit {
namespace {

using simulation::ReadPoints;

constexpr Column columns[] = {
    {"scene", "name of the scene"},
    {"effect", "omitted effect; none: the complete scene"},
    {"accuracy_rel", "target accuracy of the tips, over the length"},
    {"error_without_rel",
     "distance of the tips from those of the complete scene: rms over frames and "
     "strands, over the length"},
    {"change_error_rel",
     "change of error_without_rel with twice the elements and half the step"},
    {"discretisation_rel",
     "distance that the tips of the complete scene move with twice the elements "
     "and half the step"},
    {"change_over_discretisation", "error_without_rel over discretisation_rel"},
    {"error_alone_rel",
     "distance of the tips with this effect only from those without any effect"},
    {"error_of",
     "measure of the distances. strand: largest along the strands, at the ends of 16 "
     "equal parts of each, rms over the frames. Empty: tip. Scenes with a held tip have "
     "the first"},
    {"cost_share", "part of the wall time saved when the effect is left out", true},
    {"cost_alone_share",
     "time that this effect adds to a run without any effect, over the time of "
     "that run",
     true},
    {"wall_s",
     "time of the whole scene: of the processor, or of short ones the median of repeats",
     true},
    {"load_over_weight",
     "load of the effect, rms over frames and points, over the weight"},
    {"gravito_bending", "rho g S L^3/(EI): weight over bending, first strand"},
    {"inertia_bending", "rho a S L^3/(EI), a the root's rms acceleration"},
    {"twist_bending", "GJ/(EI)"},
    {"verdict",
     "keep, drop, too close to call, or cannot tell with the discretisation error that "
     "prevents it, for this accuracy"},
};

constexpr std::string_view shipped_scenes =
    "scenes/cantilever.toml,scenes/curly_clump_oscillation.toml,"
    "scenes/hair_under_wind.toml,scenes/head_shaking.toml,"
    "scenes/spring_experiment.toml,scenes/twist_experiment.toml";

constexpr Parameter own_settings[] = {
    {.name = "accuracy",
     .help = "target accuracy of the tips over the length",
     .number = 0.01,
     .min = 1e-9,
     .max = 10},
    {.name = "strands",
     .help = "number of strands sampled from a groom without interaction",
     .number = 8,
     .min = 1,
     .max = 1e6,
     .whole = true},
    {.name = "scenes",
     .help = "scene files, as in scenes/a.toml,scenes/b.toml",
     .text = true,
     .fallback = shipped_scenes},
};

constexpr OwnOption command_options[] = {
    {"scene", "scenes",
     "your own scene (several: a.toml,b.toml) instead of the built-in ones", true},
};

void set_numbers(const Scene& scene, Row& row) {
  const ScaleNumbers numbers = scale_numbers(scene);
  row.set("gravito_bending", numbers.gravito_bending);
  row.set("inertia_bending", numbers.inertia_bending);
  row.set("twist_bending", numbers.twist_bending);
}

/// The refined complete scene, the reference of all rows of a scene; empty if it does not
/// run: each row then reports why.
std::shared_ptr<const TipPaths> refined_whole(const Scene& scene,
                                              const ReadPoints& read) {
  try {
    return std::make_shared<const TipPaths>(tip_paths(refined(scene), 0, {}, read));
  } catch (const std::runtime_error&) {
    return {};
  }
}

struct Work {
  Scene scene;
  std::shared_ptr<const TipPaths> fine;
  Ingredient ingredient;  // no name: the complete scene
  double accuracy;
  int repeat;
  ReadPoints read;

  TipPaths timed(const Scene& run) const { return tip_paths(run, repeat, {}, read); }
  TipPaths once(const Scene& run) const { return tip_paths(run, 0, {}, read); }
};

void add_change(const Work& work, const TipPaths& whole, const TipPaths& whole_fine,
                double discretisation, Row& row) {
  const Scene& scene = work.scene;
  const auto& left_out = work.ingredient.without;
  TipPaths without, without_fine;
  try {
    without = work.timed(left_out(scene));
    without_fine = work.once(left_out(refined(scene)));
  } catch (const InputError&) {
    throw;
  } catch (const std::runtime_error& failure) {
    row.set("verdict", "keep");  // at this step the scene fails without it
    throw;
  }
  const double change = distance_rel(whole, without, scene);
  const double change_error =
      std::abs(change - distance_rel(whole_fine, without_fine, scene));
  row.set("error_without_rel", change).set("change_error_rel", change_error);
  row.set("change_over_discretisation", change / discretisation);
  row.set("cost_share", 1 - without.wall_s / whole.wall_s);
  row.set("verdict", verdict({change, change_error, discretisation}, work.accuracy));
}

/// Left empty where the scene without the others does not run: one effect alone is not a
/// requested scene.
void add_alone(const Work& work, Row& row) {
  if (!work.ingredient.alone) return;
  try {
    const TipPaths none = work.timed(bare(work.scene));
    const TipPaths alone = work.timed(work.ingredient.alone(work.scene));
    row.set("error_alone_rel", distance_rel(none, alone, work.scene));
    row.set("cost_alone_share", alone.wall_s / none.wall_s - 1);
  } catch (const std::runtime_error&) {
  }
}

void measure(const Work& work, Row& row) {
  const Scene& scene = work.scene;
  const TipPaths whole = work.timed(scene);
  const TipPaths whole_fine = work.fine ? *work.fine : work.once(refined(scene));
  const double discretisation = distance_rel(whole, whole_fine, scene);
  row.set("wall_s", whole.wall_s).set("discretisation_rel", discretisation);
  if (work.read.parts > 0) row.set("error_of", "strand");
  set_numbers(scene, row);
  if (work.ingredient.name.empty()) return;

  row.set("load_over_weight", load_over_weight(scene, work.ingredient.name));
  add_alone(work, row);
  add_change(work, whole, whole_fine, discretisation, row);
}

void run(const Work& work, Row& row) {
  try {
    measure(work, row);
  } catch (const InputError& refused) {
    row.failed("refused", refused.what());
  } catch (const std::runtime_error& failure) {
    row.failed("diverged", failure.what());
  }
}

/// Effects are judged by the paths of tips, or by points along the strands where a
/// support prescribes the path of a tip.
ReadPoints judged_points(const Scene& scene) {
  if (scene.tables == nullptr) return {};
  for (const simulation::Table& support : scene.tables->supports) {
    const Parameters& p = support.values();
    const std::string_view at = p.word("at");
    const bool held = p.word("kind") != "direction" &&
                      p.number("stiffness_n_per_m") == 0 && norm(p.vec("slide")) == 0;
    if (held && (at == "tip" || decimal(at) == 1)) return simulation::along_strands;
  }
  return {};
}

std::vector<Case> cases(const CommandLine& line) {
  const Settings settings(line, own_settings);
  const double accuracy = settings.experiment().number("accuracy");
  std::vector<Case> all;
  const auto strands = static_cast<std::size_t>(settings.experiment().whole("strands"));
  const auto files = listed_files(settings.experiment().word("scenes"), "scenes");
  for (const Scene& given : read_scenes(files)) {
    const ReadPoints read = judged_points(given);
    const Scene scene = thinned(given, strands);
    if (scene.strands.empty()) {
      throw InputError("nothing to leave out: the model brings its own effects",
                       "scene " + scene.name, "give a scene with [strand] or [groom]");
    }
    std::vector<Ingredient> parts = ingredients(scene);
    parts.insert(parts.begin(), Ingredient{});
    const auto fine = line.dry_run ? nullptr : refined_whole(scene, read);
    for (const Ingredient& part : parts) {
      Row identity;
      identity.set("scene", scene.name);
      identity.set("effect", part.name.empty() ? "none" : part.name);
      identity.set("accuracy_rel", accuracy);
      const Work work{scene, fine, part, accuracy, line.repeat, read};
      all.push_back({identity, [work](Row& row, const auto&) { run(work, row); }});
    }
  }
  return all;
}

bool shows_all_shipped(const std::vector<Row>& rows) {
  return std::ranges::all_of(
      split(std::string(shipped_scenes), ',', "scenes"), [&](const std::string& file) {
        const std::string scene = std::filesystem::path(file).stem().string();
        return std::ranges::any_of(
            rows, [&](const Row& row) { return row.text("scene") == scene; });
      });
}

void judge(const std::vector<Row>& rows, Verdicts& verdicts) {
  int kept = 0, dropped = 0;
  double wrong = 0;
  for (const Row& row : rows) {
    if (row.text("verdict") == "keep") ++kept;
    if (row.text("verdict") != "drop") continue;
    ++dropped;
    wrong = std::max(wrong, row.number("error_without_rel") / row.number("accuracy_rel"));
  }
  // These need not hold for other scenes.
  const bool shipped = shows_all_shipped(rows);
  verdicts.check_found("some effect has to be kept", kept > 0, shipped, kept);
  verdicts.check_found("some effect may be dropped", dropped > 0, shipped, dropped);
  const std::string claim = "no dropped effect changes more than the accuracy";
  if (dropped > 0) {
    verdicts.check(claim, wrong <= 1, wrong);
  } else {
    verdicts.not_judged(claim);
  }
}

/// What leaving out each effect does, over the whole scene.
void answer(const CommandLine& line, const std::vector<Row>& rows) {
  std::vector<std::string> lines;
  for (const Row& row : rows) {
    const std::string_view scene = row.text("scene"), effect = row.text("effect");
    if (!row.ok()) {
      lines.push_back(
          fmt::format("{}: {}: no answer: {}", scene, effect, row.text("reason")));
    } else if (effect == "none") {
      lines.push_back(fmt::format(
          "{}: its elements and steps are off by {:.2g} % of the length, over the whole "
          "scene; target accuracy {:.2g} %",
          scene, 1e2 * row.number("discretisation_rel"),
          1e2 * row.number("accuracy_rel")));
    } else {
      const double saved = 1e2 * row.number("cost_share");
      lines.push_back(fmt::format(
          "{}: {}: {} (without it the {} by {:.2g} % of the length, and the run takes "
          "{:.0f} % {} time)",
          scene, effect, row.text("verdict"),
          row.text("error_of") == "strand" ? "strands move" : "tips move",
          1e2 * row.number("error_without_rel"), std::abs(saved),
          saved < 0 ? "more" : "less"));
    }
  }
  print_answer(line, lines);
}

constexpr Unused unused[] = {{"models", "the scene files set them"},
                             {"integrators", "the scene files set them"},
                             {"elements", "the scene files set them"},
                             not_random};

}  // namespace
}  // namespace tress::experiments::effect_audit

int main(int argc, char** argv) {
  using namespace tress::experiments;
  using namespace tress::experiments::effect_audit;
  const Experiment experiment{
      .name = "effect_audit",
      .question = "which effects of a scene change the result, and what does each cost?",
      .example = "--set scenes=scenes/head_shaking.toml --set accuracy=0.01",
      .sizes = {"33 rows, 50 s", "the same rows"},
      .columns = columns,
      .settings = own_settings,
      .options = command_options,
      .unused = unused,
      .cases = cases,
      .checks = judge,
      .finding = finding,
      .conclude = answer};
  return run_experiment(experiment, argc, argv);
}
