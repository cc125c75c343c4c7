// Whether an effect of a scene has to stay, for a target accuracy.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "simulation/files/row.h"

namespace tress::experiments::effect_audit {

/// Changes by an effect, all over the length. They are the distance of the tips without
/// it, the change of that distance in a refined scene, and the discretisation error of
/// the scene.
struct Change {
  double change, change_error, discretisation;
};

/// Returns keep, drop, too close to call, or why nothing can be told, for a target
/// accuracy.
///
/// An effect is kept when its change exceeds both the accuracy and the discretisation
/// error. It is dropped when its change is below the accuracy. Both margins must exceed
/// the change's own error. The discretisation error is no bound to drop below: where it
/// exceeds the accuracy, an effect between the two matters more than the target accuracy.
inline std::string verdict(const Change& of, double accuracy) {
  if (of.change - of.change_error > std::max(accuracy, of.discretisation)) return "keep";
  if (of.change + of.change_error < accuracy) return "drop";
  if (of.discretisation <= accuracy) return "too close to call";
  return fmt::format("cannot tell: discretisation {:.2g} %", 1e2 * of.discretisation);
}

/// Returns whether a failed row is a valid result: the scene fails without one of its
/// effects, or cannot be without it. A process that was killed or crashed is none.
inline bool finding(const simulation::Row& row) {
  return row.text("effect") != "none" &&
         (row.status() == "diverged" || row.status() == "refused");
}

}  // namespace tress::experiments::effect_audit
