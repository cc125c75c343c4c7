#pragma once

#include <algorithm>
#include <limits>

#include "contract/integrator.h"
#include "simulation/head/make_head.h"

namespace tress::testing_support {

using integrators::HeadMethod;

/// A method of heads, and the integrator of its strands by themselves.
struct HairMethod {
  HeadMethod method;
  const char *id, *name;
  /// What a step leaves over Newton's tolerance, at most. A stage of tr_bdf2 leaves an
  /// acceleration that is wrong by the tolerance over (d h)^2; beside itself it enters
  /// the next stage 2 w/d = 2.4 times, and the last one the next step once more: 6.8 in
  /// all.
  double left;
  int solved = std::numeric_limits<int>::max();  // the first steps that iterate
  /// Of so many steps.
  double left_after(int steps) const {
    return std::min(steps, solved) * left * Options{}.newton_tolerance;
  }
};
inline constexpr HairMethod one_solve{HeadMethod::linearly_implicit_euler,
                                      "linearly_implicit_euler", "", 0, 0},
    newton{HeadMethod::backward_euler, "backward_euler", "Newton", 1},
    midpoint{HeadMethod::linearly_implicit_midpoint, "linearly_implicit_midpoint",
             "Midpoint", 1, 2},
    tr_bdf2{HeadMethod::tr_bdf2, "tr_bdf2", "TrBdf2", 7};
/// Those with the exact Jacobian.
inline constexpr const HairMethod* exact_methods[] = {&newton, &midpoint, &tr_bdf2};

}  // namespace tress::testing_support
