#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "experiments/cost_of_accuracy/trial_scene.h"
#include "experiments/problems/strand_reference.h"

namespace tress::experiments::cost_of_accuracy {

/// What of a scene is compared: tips of so many strands at all frames up to a horizon.
struct Comparison {
  double rate = 60;         // frames per second
  std::size_t frames = 30;  // the horizon
  std::size_t strands = 1;  // of a groom
  double length = 0;        // of the strands, mean (m)
  /// Which of the strands; none: all. Typical ones of the scene as its file has it: they
  /// are the same however strands are cut.
  std::vector<std::size_t> chosen = {};

  double horizon() const { return static_cast<double>(frames) / rate; }
};
Comparison comparison(const Scene& given, double rate, double horizon,
                      std::size_t strands);

/// The scene as a run of the comparison: its strands, its frames.
Scene compared(Scene scene, const Comparison& comparison);

/// The tips of the rod itself, frame after frame from t = 0 on, as super_helix and der
/// agree on them: models of different families, reduced and maximal coordinates.
struct SceneReference {
  TipReference tips;
  std::size_t frames = 0;
};

struct ReferenceCut {
  int elements = 160, substeps = 64;
  ReferenceCut refined() const { return {2 * elements, 2 * substeps}; }
  ReferenceCut halved() const { return {elements / 2, substeps / 2}; }
};

/// Computed anew. Throws std::runtime_error where one of the runs fails.
SceneReference scene_reference(const Scene& given, const Comparison& comparison,
                               const ReferenceCut& cut);

/// The reference up to the last frame at which the two sides are at most `gap` apart, rms
/// from the start: undamped strands are chaotic, and beyond there nobody knows the
/// answer. At least one frame.
SceneReference agreed(const SceneReference& reference, const Comparison& comparison,
                      double gap);

/// As far as the comparison goes.
SceneReference first_frames(const SceneReference& reference,
                            const Comparison& comparison);

/// What the two sides of a kept reference are, in words for its manifest.
struct ReferenceSides {
  std::string what, one, other;
};

/// References kept as <folder>/<name>.csv, the places of both sides, with a manifest
/// <name>.meta.json that says what they belong to. Nothing where there is no such file,
/// it is damaged or belongs to another key.
std::optional<SceneReference> load_reference(const std::string& folder,
                                             const std::string& name,
                                             const std::string& key);
void save_reference(const std::string& folder, const std::string& name,
                    const std::string& key, const SceneReference& reference,
                    const Comparison& comparison, const ReferenceCut& cut);
void save_reference(const std::string& folder, const std::string& name,
                    const std::string& key, const SceneReference& reference,
                    const Comparison& comparison, const ReferenceCut& cut,
                    const ReferenceSides& sides);

/// 16 hexadecimal digits of all that the reference depends on but the code.
std::string reference_key(const Scene& given, const Comparison& comparison,
                          const ReferenceCut& cut);

/// Loaded where it is there, else computed by `make` and saved.
using MakeReference = std::function<SceneReference(
    const Scene& given, const Comparison& comparison, const ReferenceCut& cut)>;
SceneReference kept_sides(const Scene& given, const Comparison& comparison,
                          const ReferenceCut& cut, const std::string& folder,
                          const std::string& name, const ReferenceSides& sides,
                          const MakeReference& make);
/// The same of the rod's tips, by scene_reference.
SceneReference kept_reference(const Scene& given, const Comparison& comparison,
                              const ReferenceCut& cut, const std::string& folder,
                              const std::string& name);

}  // namespace tress::experiments::cost_of_accuracy
