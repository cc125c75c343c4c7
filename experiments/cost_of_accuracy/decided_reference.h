#pragma once

#include <optional>
#include <string>

#include "experiments/cost_of_accuracy/scene_measure.h"
#include "experiments/cost_of_accuracy/scene_reference.h"
#include "experiments/run/experiment.h"
#include "experiments/run/progress.h"

namespace tress::experiments::cost_of_accuracy {

/// Target gaps of a reference, over the length.
struct WantedGap {
  double sought;   // it is refined until its sides are this close
  double allowed;  // where time is over before that, this will do
};

/// A reference that was refined until two families of models agree, or time was over.
struct DecidedReference {
  SceneReference reference;  // of all frames; `tip` is the side that changed less
  ChangedTips changed;       // as kept_changed_tips()
  std::string how;           // "super_helix and der, 80 elements, tolerance 1e-05"
};

/// Computes the reference with super_helix and der with esdirk43 (tr_bdf2 where some
/// contact is exact). Each is extrapolated in elements from the last two of 10, 20, 40
/// ... 640 elements (multiples of element_unit()), with a tolerance far below `sought`
/// that falls as well. The two are done when they are as close as is sought over all
/// frames and the last refinement changed each by no more than that. They are also done
/// when both have converged and their distance is allowed. Where time is over before, or
/// both have converged to different motions, articulated_chain decides: the pair that is
/// closest for longest is the reference. Where super_helix has a limit, it is one of
/// them. In scenes with supports or joints, corde runs if these three do not decide.
///
/// Both sides run at the same time, each on a thread. Throws std::runtime_error where
/// fewer than two models reach the end.
DecidedReference decided_reference(const Scene& given, const Comparison& comparison,
                                   const WantedGap& wanted, const Deadline& deadline,
                                   Heartbeat& heartbeat);

/// Loaded if stored in `folder`, else computed, and saved there if its sides are as
/// close as is allowed. An empty folder keeps nothing.
DecidedReference kept_decided(const Scene& given, const Comparison& comparison,
                              const WantedGap& wanted, const Deadline& deadline,
                              Heartbeat& heartbeat, const std::string& folder,
                              const std::string& name);

}  // namespace tress::experiments::cost_of_accuracy
