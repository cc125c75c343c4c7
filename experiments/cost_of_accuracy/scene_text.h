#pragma once

#include <string>
#include <vector>

#include "simulation/scene/changes.h"

namespace tress {

/// A scene file whose [model], [integrator], numbers of elements and steps are for others
/// to choose. Frames come `rate` times a second, and steps divide a frame.
class SceneText {
 public:
  /// Throws InputError as read_scene does, and where the scene has no strand or strands
  /// that touch each other.
  explicit SceneText(const std::string& file);

  const std::string& file() const { return file_; }
  const Scene& given() const { return given_; }  // as the file has it

  /// The text of a scene file: of the model and the integrator only what `method` says,
  /// Newton's tolerance newton_tolerance. Other files that it names are named by their
  /// full paths, so that it may lie in any folder.
  std::string with(const Method& method, int elements, int substeps, double rate) const;
  /// The same, read. Throws InputError where the method cannot do the scene.
  Scene scene(const Method& method, int elements, int substeps, double rate) const;

  /// What the answer of the rod itself depends on, for keys of references: the text
  /// without what is chosen, however it is written.
  std::string physics() const;

  /// Newton's corrections below 1e-6 of the scale of an unknown: a thousandth of the
  /// smallest error that is asked for.
  static constexpr double newton_tolerance = 1e-6;

 private:
  std::string file_, text_;
  Scene given_;
};

}  // namespace tress
