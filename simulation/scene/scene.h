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
struct FittedGroom;
class StrandSeries;

/// One [effects.id] that a scene names.
struct EffectChoice {
  const EffectEntry* entry = nullptr;      // entry of the catalogue of effects
  Parameters parameters;                   // values of its parameters
  std::optional<std::size_t> strand = {};  // the one that it acts on; none: all
};

/// Natural strains of strands: those of their tables (`natural`), or such that the shapes
/// at t = 0 are at rest (`inverse`, simulation/rest).
enum class RestStrains { natural, inverse };
/// Treatment of strands that would fall with inverse natural strains: they are made
/// stiffer (`stiffen`), fall (`keep`), or are left out (`drop`).
enum class Unstable { stiffen, keep, drop };
/// Effect of a failed strand: it ends the run (`end_run`), or stays where it is while the
/// others go on (`stay`).
enum class FailedStrands { end_run, stay };

/// The contents of a scene file, checked and complete: everything a run needs, with
/// nothing constructed yet.
struct Scene {
  std::string name;    // of the file, without folder and ending
  std::string title;   // one line
  std::string source;  // origin of the scene

  const ModelEntry* model = nullptr;  // entry of the catalogue of models
  /// The model's own options; for a model with its own geometry (no `strands`) all of its
  /// parameters.
  Parameters model_options{{}, "model"};
  std::string integrator;  // id of the integrator
  Options options;         // options.step: s

  /// Ready to simulate: material, discretisation, shapes, and the root's rest position
  /// and motion, which is `head` for all of them.
  std::vector<Strand> strands;
  /// The other strands of grooms with guides: not simulated, drawn as these carry them.
  std::vector<Strand> followers;
  /// The tables that describe them; null if there are none.
  std::shared_ptr<const StrandTables> tables;
  /// Distances of strands from the files of their grooms, at the time of reading.
  std::vector<std::shared_ptr<const FittedGroom>> fitted;
  RootMotion head;  // the rigid motion of roots and of bodies that follow them

  /// Effects on each strand, then the effect between strands.
  std::vector<EffectChoice> effects;

  double duration = 0;     // s
  double frame_rate = 0;   // 1/s, of the series and the geometry
  double checkpoint = 0;   // s between saved states; 0: none
  std::uint64_t seed = 1;  // seed of all random numbers
  bool guard = true;       // impossible states end the run (simulation/run/guard.h)
  RestStrains rest = RestStrains::natural;  // natural strains
  Unstable unstable = Unstable::stiffen;    // treatment of strands that fall
  FailedStrands failed_strands = FailedStrands::end_run;  // treatment of failed strands

  // Of effects between strands; null if the scene names none.
  /// Returns the parameters of forces between strands that touch.
  const Parameters* interaction() const { return parameters_of("strand_interaction"); }
  /// Returns the parameters of friction between strands.
  const Parameters* friction() const { return parameters_of("strand_friction"); }
  /// Returns the parameters of the control mesh.
  const Parameters* mesh() const { return parameters_of("control_mesh"); }
  /// Returns true if one of these effects is named.
  bool strands_touch() const {
    return interaction() != nullptr || friction() != nullptr || mesh() != nullptr;
  }

  /// Steps are chosen by error control, for each system of strands by itself.
  bool chooses_steps() const;

  /// The first frame is 0, at t = 0; the last is at the end, which may cut the last
  /// interval short.
  std::size_t last_frame() const;
  /// Returns the time of a frame, s.
  double time_of(std::size_t frame) const {
    return std::min(static_cast<double>(frame) / frame_rate, duration);
  }

 private:
  const Parameters* parameters_of(std::string_view effect) const;
};

/// A scene whose strands may be too many to be held at once.
struct SceneOutline {
  Scene scene;  // whose `strands` are the first of each [strand] and [groom] only
  std::shared_ptr<const StrandSeries> series;  // all of them; null if there are none
};

/// Throws InputError with file:line:column, what is wrong and what is accepted.
Scene read_scene(const std::string& file);
/// Reads a scene file as above, for up to a million strands; strands after the first of
/// their table are not checked.
SceneOutline read_outline(const std::string& file);
/// Reads several scene files with different names, which identify scenes in tables.
std::vector<Scene> read_scenes(const std::vector<std::string>& files);
/// Read a scene, or its outline, from a text; `file` is its name in messages, and files
/// that the scene names are relative to its folder.
Scene parse_scene(const std::string& text, const std::string& file);
/// Reads the outline of a scene from a text; see parse_scene().
SceneOutline parse_outline(const std::string& text, const std::string& file);

/// Lengths of the segments of each strand, root to tip, m. Throws InputError, naming the
/// strand, where one has branches.
std::vector<std::vector<double>> segment_lengths(const std::vector<Strand>& strands);

/// An effect on each strand; null: it acts between strands. Where strands rub, bodies are
/// obstacles that may be (Effect::obstacle).
std::shared_ptr<const Effect> make_effect(const Scene& scene, const EffectChoice& choice);
/// The effects on each strand, constructed for one.
Effects make_effects(const Scene& scene);
/// Returns the ids of the effects, the second body being body_2, the third body_3; then
/// that of the effect between strands.
std::vector<std::string> effect_names(const Scene& scene);

}  // namespace tress::simulation
