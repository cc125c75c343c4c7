#pragma once

#include <string>
#include <vector>

#include "experiments/cost_of_accuracy/scene_reference.h"

namespace tress::experiments::cost_of_accuracy {

/// The moduli and the length of strands, all increased by data_change or all decreased:
/// they are not known better. Moduli of hair scatter by tens of per cent between hairs,
/// and two per cent of a length is a curl pulled a little straighter. The solution
/// changes with them, but the error that a run adds must not depend on them.
inline constexpr double data_change = 0.02;
enum class Change { up, down };
Scene changed(Scene scene, Change change);

/// Tips of the rod with changed data, as in SceneReference.
struct ChangedTips {
  std::vector<double> up, down;
};

/// The reference plus the effect of the change on one fine run, `cut` of super_helix by
/// implicit_midpoint:
///
///     x(changed) = x + (fine(changed) - fine).
///
/// The error e of the fine run cancels except for its own change with the data, a few
/// times data_change e: with e = 1 % of the length less than 1e-3 of it. The change
/// itself need not be small. Three runs; stored beside the reference as <name>.changed.
ChangedTips kept_changed_tips(const Scene& given, const Comparison& comparison,
                              const SceneReference& reference, const ReferenceCut& cut,
                              const std::string& folder, const std::string& name);

}  // namespace tress::experiments::cost_of_accuracy
