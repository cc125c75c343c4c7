#include "integrators/sundials/cvode.h"

namespace tress::integrators {

Cvode::Cvode(std::string_view id, System& system, const Options& options,
             std::span<const Formulation> formulations, int method, int order)
    : Driver(id, system, options, formulations, 0),
      equations_(system, options),
      memory_(require(CVodeCreate(method, context_.handle()), "CVodeCreate")) {
  void* const memory = memory_.get();
  require(send_messages(memory_, context_.messages), "CVodeSetErrHandlerFn");
  require(CVodeInit(memory, &FirstOrder::rate_callback, time_, y_.handle()), "CVodeInit");
  require(CVodeSetUserData(memory, &equations_), "CVodeSetUserData");
  require(CVodeSVtolerances(memory, options.rtol, atol_.handle()), "CVodeSVtolerances");
  require(CVodeSetMaxOrd(memory, order), "CVodeSetMaxOrd");
  require(CVodeSetMaxStep(memory, options.max_step), "CVodeSetMaxStep");
  require(CVodeSetMaxHnilWarns(memory, -1), "CVodeSetMaxHnilWarns");
  if (options.newton_coefficient > 0) {
    require(CVodeSetNonlinConvCoef(memory, options.newton_coefficient),
            "CVodeSetNonlinConvCoef");
  }
}

int Cvode::restart() {
  equations_.begin();
  return CVodeReInit(memory_.get(), time_, y_.handle());
}

int Cvode::step(double t_end, double& t) {
  int code = CVodeSetStopTime(memory_.get(), t_end);
  if (code < 0) return code;
  code = CVode(memory_.get(), t_end, y_.handle(), &t, CV_ONE_STEP);
  // The fixed-point iteration of 6.4 treats any failure of the model as recoverable.
  return code >= 0 && equations_.gave_up() ? CV_RHSFUNC_FAIL : code;
}

Stats Cvode::counters() const {
  long errors = 0, stalls = 0, iterations = 0;
  CVodeGetNumErrTestFails(memory_.get(), &errors);
  CVodeGetNumStepSolveFails(memory_.get(), &stalls);
  CVodeGetNumNonlinSolvIters(memory_.get(), &iterations);  // of Adams' fixed point
  Stats stats;
  stats.rejected = errors + stalls;
  stats.newton_iterations = iterations;
  return stats;
}

std::string Cvode::reason(int code) const {
  return code_name(&CVodeGetReturnFlagName, code);
}

}  // namespace tress::integrators
