#include "integrators/sundials/ida.h"

#include <algorithm>

#include "integrators/entry.h"

namespace tress::integrators {
namespace {

constexpr std::string_view ida_id = "ida";
constexpr int ida_highest_order = 5;
constexpr std::array ida_formulations{Formulation::parametric, Formulation::acceleration,
                                      Formulation::baumgarte, Formulation::index2_ggl,
                                      Formulation::index3};
constexpr Parameter own_ida[] = {
    {.name = "suppress_algebraic",
     .help = "whether multipliers are left out of the error test",
     .choices = "true|false"},
    {.name = "multiplier_atol",
     .help = "multipliers' absolute tolerance over atol",
     .number = 1e6,
     .min = 0,
     .max = 1e30},
};

int residual(sunrealtype t, N_Vector y, N_Vector y_dot, N_Vector f, void* form) noexcept {
  return sundials_code(
      static_cast<DaeForm*>(form)->residual(t, entries(y), entries(y_dot), entries(f)));
}

std::unique_ptr<DaeNewton> make_newton(DaeForm& form, const Options& options) {
  if (form.m == 0) return std::make_unique<EliminatedNewton>(form);
  return std::make_unique<AssembledNewton>(form, options);
}

}  // namespace

Ida::Ida(System& system, const Options& options)
    : Driver(ida_id, system, options, ida_formulations,
             DaeForm::multipliers(system, options.formulation)),
      form_(system, options),
      newton_(make_newton(form_, options)),
      y_dot_(context_, static_cast<int>(y_.values().size())),
      id_(context_, static_cast<int>(y_.values().size())),
      memory_(require(IDACreate(context_.handle()), "IDACreate")),
      linear_(context_, *newton_) {
  void* const memory = memory_.get();
  require(send_messages(memory_, context_.messages), "IDASetErrHandlerFn");
  require(IDAInit(memory, &residual, time_, y_.handle(), y_dot_.handle()), "IDAInit");
  require(IDASetUserData(memory, &form_), "IDASetUserData");
  require(IDASVtolerances(memory, options.rtol, atol_.handle()), "IDASVtolerances");
  form_.differential(id_.values());
  require(IDASetId(memory, id_.handle()), "IDASetId");
  const Parameters chosen = own_options(options, own_ida);
  multiplier_atol_ = chosen.number("multiplier_atol");
  require(IDASetSuppressAlg(memory, chosen.word("suppress_algebraic") == "true"),
          "IDASetSuppressAlg");
  require(IDASetMaxOrd(memory, chosen_order(ida_id, options, ida_highest_order, 1, 5)),
          "IDASetMaxOrd");
  require(IDASetMaxStep(memory, options.max_step), "IDASetMaxStep");
  linear_.attach(memory_);
  if (options.refresh == Refresh::every_step) {
    require(IDASetDeltaCjLSetup(memory, 0), "IDASetDeltaCjLSetup");
  }
  if (options.newton_coefficient > 0) {
    require(IDASetNonlinConvCoef(memory, options.newton_coefficient),
            "IDASetNonlinConvCoef");
  }
}

int Ida::restart() {
  const Out y = y_.values(), tolerances = atol_.values().subspan(2 * form_.n);
  Status s = form_.consistent(time_, y, y_dot_.values());
  if (s == Status::ok) s = form_.multiplier_scale(time_, y, tolerances);
  if (s != Status::ok) return IDA_FIRST_RES_FAIL;
  for (double& entry : tolerances) entry *= multiplier_atol_ * options_.atol;
  const int code = IDASVtolerances(memory_.get(), options_.rtol, atol_.handle());
  if (code < 0) return code;
  return IDAReInit(memory_.get(), time_, y_.handle(), y_dot_.handle());
}

int Ida::step(double t_end, double& t) {
  const int code = IDASetStopTime(memory_.get(), t_end);
  if (code < 0) return code;
  return IDASolve(memory_.get(), t_end, &t, y_.handle(), y_dot_.handle(), IDA_ONE_STEP);
}

Stats Ida::counters() const {
  long errors = 0, stalls = 0, iterations = 0;
  IDAGetNumErrTestFails(memory_.get(), &errors);
  IDAGetNumStepSolveFails(memory_.get(), &stalls);
  IDAGetNumNonlinSolvIters(memory_.get(), &iterations);
  Stats stats;
  stats.rejected = errors + stalls;
  stats.newton_iterations = iterations;
  return stats;
}

std::string Ida::reason(int code) const { return code_name(&IDAGetReturnFlagName, code); }

IntegratorEntry ida_entry() {
  return {
      .id = "ida",
      .summary = "BDF on the residual form, orders 1-5",
      .source = "SUNDIALS IDA",
      .adaptive = true,
      .tangent = true,
      .formulations = of_order(ida_highest_order, ida_formulations),
      .gaps = {{Formulation::projection, "holds g = 0 itself: use its own formulations"}},
      .parameters = own_ida,
      .make = make_method<Ida>};
}

}  // namespace tress::integrators
