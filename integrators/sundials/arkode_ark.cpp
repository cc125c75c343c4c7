#include "integrators/sundials/arkode_ark.h"

#include <algorithm>

#include "integrators/entry.h"
#include "integrators/position_based/position_sweeps.h"
#include "integrators/sundials/arkstep.h"

namespace tress::integrators {
namespace {

constexpr std::string_view ark_id = "arkode_ark";
constexpr std::array ark_formulations{Formulation::parametric};

}  // namespace

ElasticPart::ElasticPart(System& system)
    : system_(system),
      form_(*system.compliance_form()),
      whole_form_(system.explicit_form()),
      whole_(static_cast<std::size_t>(system.layout().coordinates)) {}

ExplicitForm* ElasticPart::explicit_form() {
  return whole_form_ == nullptr ? nullptr : this;
}

Status ElasticPart::add_rest(double t, In q, In v, In a) noexcept {
  const Status s = form_.rest(t, q, v, whole_);
  for (std::size_t i = 0; i < whole_.size(); ++i) whole_[i] += a[i];
  return s;
}

Status ElasticPart::residual(double t, In q, In v, In a, Out r) noexcept {
  const Status s = add_rest(t, q, v, a);
  return s == Status::ok ? system_.residual(t, q, v, whole_, r) : s;
}

Status ElasticPart::linearize(double t, In q, In v, In a, Weights w) noexcept {
  const Status s = add_rest(t, q, v, a);
  return s == Status::ok ? system_.linearize(t, q, v, whole_, w) : s;
}

Status ElasticPart::acceleration(double t, In q, In v, Out a) noexcept {
  if (const Status s = whole_form_->acceleration(t, q, v, a); s != Status::ok) return s;
  const Status s = form_.rest(t, q, v, whole_);
  for (std::size_t i = 0; i < whole_.size(); ++i) a[i] -= whole_[i];
  return s;
}

ArkodeArk::ArkodeArk(System& system, const Options& options)
    : Driver(ark_id, system, options, ark_formulations, 0),
      elastic_(system),
      parts_(elastic_, options),
      memory_(require(ARKStepCreate(&explicit_callback, &FirstOrder::rate_callback, time_,
                                    y_.handle(), context_.handle()),
                      "ARKStepCreate")),
      implicit_(context_, parts_) {
  void* const memory = memory_.get();
  require(send_messages(memory_, context_.messages), "ARKStepSetErrHandlerFn");
  require(ARKStepSetUserData(memory, static_cast<FirstOrder*>(&parts_)),
          "ARKStepSetUserData");
  require(ARKStepSVtolerances(memory, options.rtol, atol_.handle()),
          "ARKStepSVtolerances");
  require(ARKStepSetOrder(memory, chosen_order(ark_id, options, 4, 3, 5)),
          "ARKStepSetOrder");
  require(ARKStepSetMaxStep(memory, options.max_step), "ARKStepSetMaxStep");
  require(ARKStepSetMaxHnilWarns(memory, -1), "ARKStepSetMaxHnilWarns");
  implicit_.attach(memory_);
}

int ArkodeArk::explicit_callback(sunrealtype t, N_Vector y, N_Vector y_dot,
                                 void* self) noexcept {
  auto& parts = *static_cast<Parts*>(static_cast<FirstOrder*>(self));
  const In state = entries(y);
  const Out rate = entries(y_dot);
  const std::size_t n = state.size() / 2;
  std::ranges::fill(rate.first(n), 0.0);
  return sundials_code(parts.form.rest(t, state.first(n), state.last(n), rate.last(n)));
}

int ArkodeArk::restart() {
  parts_.begin();
  return ARKStepReInit(memory_.get(), &explicit_callback, &FirstOrder::rate_callback,
                       time_, y_.handle());
}

int ArkodeArk::step(double t_end, double& t) {
  return arkstep_step(memory_, parts_, y_.handle(), t_end, t);
}

Stats ArkodeArk::counters() const { return arkstep_counters(memory_); }

std::string ArkodeArk::reason(int code) const {
  return code_name(&ARKStepGetReturnFlagName, code);
}

IntegratorEntry arkode_ark_entry() {
  return {.id = "arkode_ark",
          .summary = "ARK4(3)6L[2]SA: elastic forces implicit, all others explicit",
          .source = "SUNDIALS ARKODE",
          .adaptive = true,
          .tangent = true,
          .formulations = of_order(4, ark_formulations),
          .gaps = gaps_of_sweeps(),
          .objection = compliances,
          .make = make_method<ArkodeArk>};
}

}  // namespace tress::integrators
