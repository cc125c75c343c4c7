#pragma once

#include <functional>
#include <optional>
#include <string_view>

#include "experiments/validation/rods/motion.h"
#include "models/strand/strand.h"

namespace tress::experiments::validation {

/// Method and contact law of a run of a contact test. The defaults are those of the
/// table.
struct ContactRun {
  /// Integrator of tests with exact contact.
  std::string_view integrator = "backward_euler";
  /// Whether surfaces are rigid. Empty: those of the test.
  std::optional<bool> rigid = {};
  /// Rotation of the whole scene: strands, bodies and loads.
  Frame turned = {};
  /// Receives the drive of friction after every accepted step of a run, m/s:
  /// ContactForm::drive().
  std::function<void(double drive)> each_drive = {};

  /// Returns whether surfaces are rigid in a test that has them so by default.
  bool is_rigid(bool by_default) const { return rigid.value_or(by_default); }
  /// Returns the strand in the rotated scene. Its root may move by translations only.
  Strand strand(Strand of_test) const;
  /// Returns a place in the rotated scene.
  StrandPlace place(const StrandPlace& of_test) const;
  /// Returns component `axis` of the position of a point, in axes of the scene (m).
  /// Passes the drive to each_drive at every call. The system must outlive the result.
  Look look(System& system, int point, int axis) const;
};

}  // namespace tress::experiments::validation
