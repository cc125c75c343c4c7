#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "experiments/cost_of_accuracy/trial_scene.h"
#include "experiments/problems/strand_reference.h"
#include "simulation/run/tip_paths.h"

namespace tress::experiments::cost_of_accuracy {

/// Compared quantities: the tips of `strands` strands, or points along them, at all
/// frames up to a horizon, and at the horizon, which may cut the last frame short.
struct Comparison {
  double rate = 60;         // frames per second
  std::size_t frames = 30;  // times of comparison after t = 0
  std::size_t strands = 1;  // of a groom
  double length = 0;        // of the strands, mean (m)
  /// Indices of the strands; empty: all. They are typical ones of the scene in its file,
  /// and so the same for every discretisation.
  std::vector<std::size_t> chosen = {};

  double end = std::numeric_limits<double>::infinity();  // s, where it is no whole frame

  /// Points along each strand, in place of the tips: a support or a joint may hold these.
  simulation::ReadPoints read = {};

  /// Returns the number of points that have one error, among those of all frames.
  std::size_t group(std::size_t points) const {
    return read.parts > 0 ? points / (frames + 1) : 1;
  }

  /// Returns the time of a frame, s.
  double time_of(std::size_t frame) const {
    return std::min(static_cast<double>(frame) / rate, end);
  }
  double horizon() const { return time_of(frames); }
};
/// A horizon of 0 is the scene's duration. A span shorter than a frame is compared at
/// several times: `rate` is higher then. Strands that are one system are all compared.
Comparison comparison(const Scene& given, double rate, double horizon,
                      std::size_t strands);

/// Returns the root mean square distance of tips, frame by frame from t = 0, over strands
/// and times of comparison, over the length. Of points along the strands it is the root
/// mean square, over the times, of the largest distance. The frame at t = 0 is left out:
/// tips are exact there. Infinite where a point is missing or not finite.
double compared_error(const std::vector<double>& tip,
                      const std::vector<double>& reference, const Comparison& comparison);

/// The scene restricted to the comparison's strands and frames.
Scene compared(Scene scene, const Comparison& comparison);

/// Runs the scene and reads the compared points. Throws as tip_paths does.
TipPaths compared_paths(const Scene& scene, const Comparison& comparison,
                        const simulation::RunLimit& limit = {});

/// The tips of the continuous rod, frame by frame from t = 0, on which super_helix and
/// der agree: models of different families, reduced and maximal coordinates.
struct SceneReference {
  TipReference tips;
  std::size_t frames = 0;
};

struct ReferenceCut {
  int elements = 160, substeps = 64;
  ReferenceCut refined() const { return {2 * elements, 2 * substeps}; }
  ReferenceCut halved() const { return {elements / 2, substeps / 2}; }
};

/// Computes the reference of a scene and reads no stored one. Throws std::runtime_error
/// where one of the runs fails.
SceneReference scene_reference(const Scene& given, const Comparison& comparison,
                               const ReferenceCut& cut);

/// Returns the reference up to the last frame at which the two sides are at most `gap`
/// apart, rms from the start. Undamped strands are chaotic, and no answer is known beyond
/// it. At least one frame.
SceneReference agreed(const SceneReference& reference, const Comparison& comparison,
                      double gap);

/// Up to the horizon of the comparison.
SceneReference first_frames(const SceneReference& reference,
                            const Comparison& comparison);

/// Descriptions of the two sides of a stored reference, for its manifest.
struct ReferenceSides {
  std::string what, one, other;
};

/// References stored as <folder>/<name>.csv, the positions of both sides, with a manifest
/// <name>.meta.json that identifies them. Empty if the file does not exist, is damaged or
/// belongs to another key.
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

/// 16 hexadecimal digits of everything except the code that the reference depends on.
std::string reference_key(const Scene& given, const Comparison& comparison,
                          const ReferenceCut& cut);

/// Loaded if stored, else computed by `make` and saved.
using MakeReference = std::function<SceneReference(
    const Scene& given, const Comparison& comparison, const ReferenceCut& cut)>;
SceneReference kept_sides(const Scene& given, const Comparison& comparison,
                          const ReferenceCut& cut, const std::string& folder,
                          const std::string& name, const ReferenceSides& sides,
                          const MakeReference& make);
/// Loads or computes the reference of the rod's tips, with scene_reference.
SceneReference kept_reference(const Scene& given, const Comparison& comparison,
                              const ReferenceCut& cut, const std::string& folder,
                              const std::string& name);

}  // namespace tress::experiments::cost_of_accuracy
