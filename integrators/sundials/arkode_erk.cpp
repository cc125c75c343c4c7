#include "integrators/sundials/arkode_erk.h"

#include <cmath>

#include "integrators/entry.h"

namespace tress::integrators {
namespace {

constexpr std::string_view erk_id = "arkode_erk";
constexpr int standard_order = 5;
constexpr double shrink = 0.25;          // of a step that the model has rejected
constexpr double shortest_step = 1e-15;  // relative to t: below it, rejection is final

}  // namespace

ArkodeErk::ArkodeErk(System& system, const Options& options)
    : Driver(erk_id, system, options, ode_formulations, 0),
      equations_(system, options),
      memory_(require(ERKStepCreate(&FirstOrder::rate_callback, time_, y_.handle(),
                                    context_.handle()),
                      "ERKStepCreate")) {
  void* const memory = memory_.get();
  require(send_messages(memory_, context_.messages), "ERKStepSetErrHandlerFn");
  require(ERKStepSetUserData(memory, &equations_), "ERKStepSetUserData");
  require(ERKStepSVtolerances(memory, options.rtol, atol_.handle()),
          "ERKStepSVtolerances");
  require(ERKStepSetOrder(memory, chosen_order(erk_id, options, standard_order, 2, 8)),
          "ERKStepSetOrder");
  require(ERKStepSetMaxStep(memory, options.max_step), "ERKStepSetMaxStep");
  require(ERKStepSetMaxHnilWarns(memory, -1), "ERKStepSetMaxHnilWarns");
}

int ArkodeErk::restart() {
  const int code = ERKStepSetInitStep(memory_.get(), 0);  // its own choice again
  if (code < 0) return code;
  return ERKStepReInit(memory_.get(), &FirstOrder::rate_callback, time_, y_.handle());
}

int ArkodeErk::step(double t_end, double& t) {
  const int code = ERKStepSetStopTime(memory_.get(), t_end);
  if (code < 0) return code;
  return ERKStepEvolve(memory_.get(), t_end, y_.handle(), &t, ARK_ONE_STEP);
}

bool ArkodeErk::recover(int code) {
  if (code != ARK_UNREC_RHSFUNC_ERR) return false;
  double h = 0;
  if (ERKStepGetCurrentStep(memory_.get(), &h) < 0) return false;
  h *= shrink;
  return h > shortest_step * std::abs(time_) && restart() >= 0 &&
         ERKStepSetInitStep(memory_.get(), h) >= 0;
}

Stats ArkodeErk::counters() const {
  Stats stats;
  ERKStepGetNumErrTestFails(memory_.get(), &stats.rejected);
  return stats;
}

std::string ArkodeErk::reason(int code) const {
  return code_name(&ERKStepGetReturnFlagName, code);
}

IntegratorEntry arkode_erk_entry() {
  return {.id = "arkode_erk",
          .summary = "explicit Runge-Kutta, orders 2-8",
          .source = "SUNDIALS ARKODE",
          .adaptive = true,
          .formulations = of_order(4, ode_formulations),
          .gaps = {{Formulation::projection,
                    "ARKODE has no projection: SUNDIALS projects in cvode_bdf only"}},
          .objection = inverts_mass,
          .make = make_method<ArkodeErk>};
}

}  // namespace tress::integrators
