#include "integrators/control/impulsive.h"
#include "integrators/entry.h"
#include "integrators/fixed_step.h"
#include "integrators/linearly_implicit_step.h"

namespace tress::integrators {
namespace {

/// Backward Euler's first Newton step from constant velocity: one linear solve per step.
/// Order 1, strongly damping. The model's Jacobian option decides which terms S includes.
/// [Baraff, Witkin 1998; Bertails et al. 2006]
class LinearlyImplicitEuler final : public FixedStep, public Impulsive {
 public:
  LinearlyImplicitEuler(System& system, const Options& options)
      : FixedStep(system, options), step_(dynamics_, options) {}

 private:
  Status go_on(In q, In v) override { return replace(q, v); }
  void lose_matrix() override { dynamics_.lose_matrix(); }

  Status reset(double /*t*/) override {
    step_.reset();
    return Status::ok;
  }

  Status step(double t, double h) override {
    const Status s = step_.take(t, h, q_, v_, lambda_);
    take(step_.q(), step_.v());
    return s;
  }

  LinearlyImplicitStep step_;
};

}  // namespace

IntegratorEntry linearly_implicit_euler_entry() {
  return {.id = "linearly_implicit_euler",
          .summary = "one linear solve, strong damping",
          .source = "Baraff-Witkin 1998",
          .impulsive = true,
          .tangent = true,
          .formulations = of_order(1, stage_formulations),
          .make = make_method<LinearlyImplicitEuler>};
}

}  // namespace tress::integrators
