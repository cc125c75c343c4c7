#pragma once

#include "integrators/sundials/first_order.h"

namespace tress::integrators {

/// Takes one step of ARKStep, no further than t_end (s), from `t` to its end, which `t`
/// is afterwards. Returns the library's code, ARK_RHSFUNC_FAIL where the equations of a
/// stage gave up.
int arkstep_step(const ArkstepMemory& memory, const FirstOrder& equations, N_Vector y,
                 double t_end, double& t);

/// Returns the counts of ARKStep that are not those of its equations: rejected steps.
Stats arkstep_counters(const ArkstepMemory& memory);

}  // namespace tress::integrators
