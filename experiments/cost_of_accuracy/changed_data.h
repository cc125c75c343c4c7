#pragma once

#include <string>
#include <vector>

#include "experiments/cost_of_accuracy/scene_reference.h"

namespace tress::experiments::cost_of_accuracy {

/// The moduli and the length of strands, each up by data_change or down: nobody knows
/// them better. Moduli of hair scatter by tens of per cent from one to the next, and two
/// per cent of a length are a curl pulled a little straighter. The answer moves with
/// them, and what a run adds to it, its error, must not depend on it.
inline constexpr double data_change = 0.02;
enum class Change { up, down };
Scene changed(Scene scene, Change change);

/// Tips of the rod with changed data, as of SceneReference.
struct ChangedTips {
  std::vector<double> up, down;
};

/// The reference plus what the change does to one fine run, `cut` of super_helix by
/// implicit_midpoint:
///
///     x(changed) = x + (fine(changed) - fine).
///
/// The error e of the fine run cancels but for its own change with the data, a few times
/// data_change e: with e = 1 % of the length less than 1e-3 of it. The change itself need
/// not be small. Three runs; kept beside the reference as <name>.changed.
ChangedTips kept_changed_tips(const Scene& given, const Comparison& comparison,
                              const SceneReference& reference, const ReferenceCut& cut,
                              const std::string& folder, const std::string& name);

}  // namespace tress::experiments::cost_of_accuracy
