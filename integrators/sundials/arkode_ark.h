#pragma once

#include "contract/forms/compliance_form.h"
#include "contract/forms/explicit_form.h"
#include "integrators/sundials/driver.h"
#include "integrators/sundials/implicit_adapter.h"

namespace tress::integrators {

/// A system without the forces outside its ComplianceForm: its residual is r(t, q, v, a +
/// rest). The tangent is that of all forces, which Newton's method takes for its own.
class ElasticPart final : public System, private ExplicitForm {
 public:
  /// Takes a system with a compliance form, which must outlive it.
  explicit ElasticPart(System& system);

  Layout layout() const override { return system_.layout(); }
  Traits traits() const override { return system_.traits(); }
  void initial_state(Out q, Out v) const override { system_.initial_state(q, v); }
  void scale(Out q_typ, Out v_typ) const override { system_.scale(q_typ, v_typ); }
  Status residual(double t, In q, In v, In a, Out r) noexcept override;
  Status linearize(double t, In q, In v, In a, Weights w) noexcept override;
  Status solve(In b, Out x) noexcept override { return system_.solve(b, x); }
  std::string not_finite(double t, In q, In v) override {
    return system_.not_finite(t, q, v);
  }
  ExplicitForm* explicit_form() override;
  StressForm* stress_form() override { return system_.stress_form(); }
  ComplianceForm* compliance_form() override { return system_.compliance_form(); }

 private:
  Status acceleration(double t, In q, In v, Out a) noexcept override;
  /// whole_ <- a + rest.
  Status add_rest(double t, In q, In v, In a) noexcept;

  System& system_;
  ComplianceForm& form_;
  ExplicitForm* whole_form_;
  std::vector<double> whole_;
};

/// ARKODE's additive Runge-Kutta methods: elastic forces and internal friction are
/// implicit, all other forces explicit (gravity, drag, wind, contact, interaction of
/// strands). The two parts are those of ComplianceForm. The implicit part is stiffly
/// accurate and L-stable. Explicit forces limit the step as in an explicit method. By
/// default ARK4(3)6L[2]SA of order 4. `max_order` 3 or 5 selects ARK3(2)4L[2]SA or
/// ARK5(4)8L[2]SA. [Kennedy & Carpenter 2003]
class ArkodeArk final : public Driver {
 public:
  /// Binds the method to a system with a compliance form, which must outlive it.
  ArkodeArk(System& system, const Options& options);

 private:
  /// The implicit part as equations of first order, and the explicit part.
  struct Parts final : FirstOrder {
    Parts(ElasticPart& elastic, const Options& options)
        : FirstOrder(elastic, options), form(*elastic.compliance_form()) {}
    ComplianceForm& form;
  };

  static int explicit_callback(sunrealtype t, N_Vector y, N_Vector y_dot,
                               void* self) noexcept;
  int restart() override;
  int step(double t_end, double& t) override;
  Stats counters() const override;
  Stats work() const override { return parts_.work(); }
  std::string reason(int code) const override;
  Dynamics& dynamics() override { return parts_.rates(); }

  ElasticPart elastic_;
  Parts parts_;
  ArkstepMemory memory_;
  ImplicitAdapter implicit_;
};

}  // namespace tress::integrators
