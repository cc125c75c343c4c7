#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "contract/integrator.h"
#include "models/catalogue.h"
#include "models/effects/catalogue.h"
#include "models/strand/strand.h"

namespace tress::simulation {

struct StrandTables;

/// One [effects.id] of a scene. What a scene does not name is not here.
struct EffectChoice {
  const EffectEntry* entry = nullptr;
  Parameters parameters;
};

/// What a scene file says, checked and complete: everything a run needs, nothing built.
struct Scene {
  std::string name;    // of the file, without folder and ending
  std::string title;   // one line
  std::string source;  // where the scene comes from

  const ModelEntry* model = nullptr;
  /// The model's own options; of a model that brings its own geometry (no `strands`) all
  /// of its parameters.
  Parameters model_options{{}, "model"};
  std::string integrator;
  Options options;  // options.step: s

  /// Ready to simulate: material, cut, shapes, and the root's rest place and motion,
  /// which is `head` for all of them.
  std::vector<Strand> strands;
  /// What they were cut from; null where no table says them.
  std::shared_ptr<const StrandTables> tables;
  RootMotion head;  // the rigid motion of roots and of bodies that follow them

  std::vector<EffectChoice> effects;
  std::optional<Parameters> interaction;  // [effects.strand_interaction]

  double duration = 0;    // s
  double frame_rate = 0;  // 1/s, of the series and the geometry
  double checkpoint = 0;  // s between saved states; 0: none
  std::uint64_t seed = 1;
  bool guard = true;  // what physics rules out ends the run (simulation/run/guard.h)

  /// The first frame is 0, at t = 0; the last is at the end, which may come before a
  /// whole frame is over.
  std::size_t last_frame() const;
  double time_of(std::size_t frame) const {
    return std::min(static_cast<double>(frame) / frame_rate, duration);
  }
};

/// Throws InputError with file:line:column, what is wrong and what would be right.
Scene read_scene(const std::string& file);
/// The same of several, whose names differ: tables tell scenes by them.
std::vector<Scene> read_scenes(const std::vector<std::string>& files);
/// The same of a text; `file` is its name in messages, and its folder that of files which
/// the scene names.
Scene parse_scene(const std::string& text, const std::string& file);

/// The effects of a scene, made for one strand.
Effects make_effects(const Scene& scene);
/// Their ids, the second body being body_2, the third body_3.
std::vector<std::string> effect_names(const Scene& scene);

}  // namespace tress::simulation
