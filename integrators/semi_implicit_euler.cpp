#include <cmath>

#include "integrators/control/impulsive.h"
#include "integrators/entry.h"
#include "integrators/fixed_step.h"
#include "integrators/semi_implicit_step.h"

namespace tress::integrators {
namespace {

/// Backward Euler's first Newton step from constant velocity: one linear solve per step.
/// Order 1, strongly damping. The model's Tangent option decides which terms S includes.
/// [Baraff, Witkin 1998; Bertails et al. 2006]
class SemiImplicitEuler final : public FixedStep, public Impulsive {
 public:
  SemiImplicitEuler(System& system, const Options& options)
      : FixedStep(system, options), step_(dynamics_, options) {}

 private:
  Status go_on(In q, In v) override { return replace(q, v); }

  bool has_matrix(double h) const override {
    // h is a difference of times.
    constexpr double rounding = 1e-9;
    return dynamics_.m() == 0 && matrix_ == dynamics_.matrix() &&
           std::abs(h - h_) <= rounding * h;
  }

  Status reset(double /*t*/) override {
    step_.reset();
    matrix_ = -1;
    return Status::ok;
  }

  Status step(double t, double h) override {
    const Status s = step_.take(t, h, q_, v_, lambda_);
    take(step_.q(), step_.v());
    matrix_ = s == Status::ok ? dynamics_.matrix() : -1;
    h_ = h;
    return s;
  }

  SemiImplicitStep step_;
  long matrix_ = -1;  // of the last step
  double h_ = 0;
};

}  // namespace

IntegratorEntry semi_implicit_euler_entry() {
  return {.id = "semi_implicit_euler",
          .summary = "one linear solve, strong damping",
          .source = "Baraff-Witkin 1998",
          .impulsive = true,
          .tangent = true,
          .formulations = of_order(1, stage_formulations),
          .make = make_method<SemiImplicitEuler>};
}

}  // namespace tress::integrators
