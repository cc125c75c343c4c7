#include "experiments/cost_of_accuracy/scene_reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <system_error>

#include "contract/input_error.h"
#include "experiments/run/message.h"
#include "simulation/files/csv.h"
#include "simulation/files/files.h"
#include "simulation/scene/joint_table.h"
#include "simulation/scene_changes/typical_strands.h"

namespace tress::experiments::cost_of_accuracy {
namespace {

/// Version of the reference computation; increment it to invalidate stored references.
constexpr int reference_version = 1;

/// Times at which a scene shorter than a frame is compared, and the largest frame rate
/// that a scene file takes (1/s).
constexpr double times_within_a_frame = 4, largest_rate = 1e6;

/// A number of frames is whole up to this.
constexpr double whole_frame = 1e-9;

constexpr std::string_view columns[] = {
    "t_s", "strand", "x_m", "y_m", "z_m", "other_x_m", "other_y_m", "other_z_m", "part"};

const ReferenceSides rod_sides{
    "tips of the rod: super_helix by implicit_midpoint, der by generalized_alpha, "
    "extrapolated in step and element length",
    "the tip by super_helix", "the tip by der"};

/// Of `columns`.
std::array<std::string, 9> help_of(const ReferenceSides& sides) {
  return {"time",     "counted from 0", sides.one,
          "the same", "the same",       sides.other,
          "the same", "the same",       "end of a part of the strand, the root is 0"};
}

std::string hash(const std::string& text) {
  Row row;
  row.set("text", text);
  return run_id("reference", row);
}

std::string csv_file(const std::string& folder, const std::string& name) {
  return folder + '/' + name + ".csv";
}
std::string meta_file(const std::string& folder, const std::string& name) {
  return folder + '/' + name + ".meta.json";
}

std::string text_of(const SceneReference& reference, const Comparison& comparison) {
  const std::size_t points = reference.tips.tip.size() / 3 / (reference.frames + 1);
  const auto each = static_cast<std::size_t>(comparison.read.parts + 1);
  std::vector<Row> rows;
  for (std::size_t i = 0; i < reference.tips.tip.size(); i += 3) {
    const std::size_t frame = i / 3 / points, point = i / 3 % points;
    Row row;
    row.set("t_s", comparison.time_of(frame));
    row.set("strand", point / each);
    if (each > 1) row.set("part", point % each);
    for (std::size_t k = 0; k < 3; ++k) {
      row.set(columns[2 + k], reference.tips.tip[i + k]);
      row.set(columns[5 + k], reference.tips.other[i + k]);
    }
    rows.push_back(std::move(row));
  }
  std::vector<std::string> names(std::begin(columns), std::end(columns));
  if (each == 1) names.pop_back();
  names.emplace_back("status");
  return to_csv(names, rows);
}

}  // namespace

Comparison comparison(const Scene& given, double rate, double horizon,
                      std::size_t strands) {
  Comparison made{.rate = rate, .strands = strands};
  const double span = horizon > 0 ? std::min(horizon, given.duration) : given.duration;
  if (span * rate < 1 - whole_frame) {
    made.rate = std::min(times_within_a_frame / span, largest_rate);
  }
  // As Scene::last_frame.
  const double frames = std::max(1.0, std::ceil(span * made.rate - whole_frame));
  made.frames = static_cast<std::size_t>(frames);
  if (frames > span * made.rate + whole_frame) made.end = span;
  const std::vector<Strand>& all = given.strands;
  const bool one_system = !simulation::SceneJoints(given).groups().empty();
  const std::vector<std::size_t> typical =
      typical_strands(all, one_system ? all.size() : strands);
  if (held(given)) made.read = simulation::along_strands;
  for (const std::size_t i : typical) made.length += all[i].length();
  made.length /= static_cast<double>(typical.size());
  if (typical.size() < all.size()) made.chosen = typical;
  return made;
}

double compared_error(const std::vector<double>& tip,
                      const std::vector<double>& reference,
                      const Comparison& comparison) {
  const std::size_t per_frame = reference.size() / (comparison.frames + 1);
  if (tip.size() < per_frame) return std::numeric_limits<double>::infinity();
  return simulation::grouped_distance(std::span(tip).subspan(per_frame),
                                      std::span(reference).subspan(per_frame),
                                      comparison.group(reference.size() / 3)) /
         comparison.length;
}

Scene compared(Scene scene, const Comparison& comparison) {
  scene.frame_rate = comparison.rate;
  scene.duration = comparison.horizon();
  return comparison.chosen.empty() ? scene : only(std::move(scene), comparison.chosen);
}

TipPaths compared_paths(const Scene& scene, const Comparison& comparison,
                        const simulation::RunLimit& limit) {
  return tip_paths(scene, 0, limit, comparison.read);
}

SceneReference scene_reference(const Scene& given, const Comparison& comparison,
                               const ReferenceCut& cut) {
  const auto tips = [&](std::string_view model, std::string_view integrator, int elements,
                        const Options& options) {
    const Method method{{&find_model(model), {}, std::string(integrator)}};
    Scene scene =
        compared(trial_scene(given, method, elements, 1, comparison.rate), comparison);
    scene.options = options;
    // Fast swings stretch der so quickly that an outdated Newton matrix fails.
    scene.options.refresh = Refresh::every_iteration;
    return compared_paths(scene, comparison).x;
  };
  const Finest finest{cut.elements, 1 / (comparison.rate * cut.substeps)};
  const SceneReference made{
      converged_rod(tips, comparison.length, {"super_helix", "der"}, finest),
      comparison.frames};
  return first_frames(made, comparison);
}

SceneReference first_frames(const SceneReference& reference,
                            const Comparison& comparison) {
  const std::size_t per_frame = reference.tips.tip.size() / (reference.frames + 1);
  SceneReference cut = reference;
  cut.frames = std::min(comparison.frames, reference.frames);
  cut.tips.tip.resize(per_frame * (cut.frames + 1));
  cut.tips.other.resize(per_frame * (cut.frames + 1));
  Comparison own = comparison;
  own.frames = cut.frames;
  cut.tips.gap = compared_error(cut.tips.other, cut.tips.tip, own);
  return cut;
}

SceneReference agreed(const SceneReference& reference, const Comparison& comparison,
                      double gap) {
  Comparison shorter = comparison;
  SceneReference cut = first_frames(reference, shorter);
  while (cut.tips.gap > gap && cut.frames > 1) {
    shorter.frames = cut.frames - 1;
    cut = first_frames(reference, shorter);
  }
  return cut;
}

std::optional<SceneReference> load_reference(const std::string& folder,
                                             const std::string& name,
                                             const std::string& key) {
  try {
    const auto meta = nlohmann::json::parse(read_file(meta_file(folder, name)));
    const std::string text = read_file(csv_file(folder, name));
    if (meta.at("key") != key || meta.at("table") != hash(text)) return {};
    SceneReference reference;
    reference.frames = meta.at("frames").get<std::size_t>();
    reference.tips.gap = meta.at("gap").get<double>();
    for (const Row& row : parse_csv(text, name).rows) {
      for (std::size_t k = 0; k < 3; ++k) {
        reference.tips.tip.push_back(row.number(columns[2 + k]));
        reference.tips.other.push_back(row.number(columns[5 + k]));
      }
    }
    return reference;
  } catch (const std::exception&) {  // missing or damaged: recomputed
    return {};
  }
}

void save_reference(const std::string& folder, const std::string& name,
                    const std::string& key, const SceneReference& reference,
                    const Comparison& comparison, const ReferenceCut& cut) {
  save_reference(folder, name, key, reference, comparison, cut, rod_sides);
}

void save_reference(const std::string& folder, const std::string& name,
                    const std::string& key, const SceneReference& reference,
                    const Comparison& comparison, const ReferenceCut& cut,
                    const ReferenceSides& sides) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  const std::string text = text_of(reference, comparison);
  nlohmann::ordered_json meta{{"what", sides.what},
                              {"key", key},
                              {"table", hash(text)},
                              {"version", reference_version},
                              {"gap", reference.tips.gap},
                              {"frames", reference.frames},
                              {"frames_per_s", comparison.rate},
                              {"length_m", comparison.length},
                              {"finest_elements", cut.elements},
                              {"finest_dt_s", 1 / (comparison.rate * cut.substeps)}};
  nlohmann::ordered_json help;
  const auto texts = help_of(sides);
  const std::size_t count = texts.size() - (comparison.read.parts > 0 ? 0 : 1);
  for (std::size_t i = 0; i < count; ++i) help[std::string(columns[i])] = texts[i];
  meta["columns"] = help;
  replace_file(csv_file(folder, name), text);
  replace_file(meta_file(folder, name), meta.dump(2) + '\n');
}

std::string reference_key(const Scene& given, const Comparison& comparison,
                          const ReferenceCut& cut) {
  std::string chosen;
  for (const std::size_t strand : comparison.chosen) {
    chosen += fmt::format(" {}", strand);
  }
  if (comparison.read.parts > 0) {
    chosen += fmt::format(" parts {}", comparison.read.parts);
  }
  if (std::isfinite(comparison.end)) chosen += fmt::format(" end {}", comparison.end);
  return hash(fmt::format("{} {} {} {}{} {} {}\n{}", reference_version, comparison.rate,
                          comparison.frames, comparison.strands, chosen, cut.elements,
                          cut.substeps, physics(given)));
}

SceneReference kept_sides(const Scene& given, const Comparison& comparison,
                          const ReferenceCut& cut, const std::string& folder,
                          const std::string& name, const ReferenceSides& sides,
                          const MakeReference& make) {
  const std::string key = reference_key(given, comparison, cut);
  if (auto found = load_reference(folder, name, key)) return *found;
  tell("{}: computing the reference, {} elements\n", name, cut.elements);
  SceneReference made = make(given, comparison, cut);
  save_reference(folder, name, key, made, comparison, cut, sides);
  return made;
}

SceneReference kept_reference(const Scene& given, const Comparison& comparison,
                              const ReferenceCut& cut, const std::string& folder,
                              const std::string& name) {
  return kept_sides(given, comparison, cut, folder, name, rod_sides, scene_reference);
}

}  // namespace tress::experiments::cost_of_accuracy
