#include "integrators/sundials/arkstep.h"

namespace tress::integrators {

int arkstep_step(const ArkstepMemory& memory, const FirstOrder& equations, N_Vector y,
                 double t_end, double& t) {
  int code = ARKStepSetStopTime(memory.get(), t_end);
  if (code < 0) return code;
  code = ARKStepEvolve(memory.get(), t_end, y, &t, ARK_ONE_STEP);
  return code < 0 && equations.gave_up() ? ARK_RHSFUNC_FAIL : code;
}

Stats arkstep_counters(const ArkstepMemory& memory) {
  long errors = 0, stalls = 0;
  ARKStepGetNumErrTestFails(memory.get(), &errors);
  ARKStepGetNumStepSolveFails(memory.get(), &stalls);
  Stats stats;
  stats.rejected = errors + stalls;
  return stats;
}

}  // namespace tress::integrators
