#include "integrators/entry.h"
#include "integrators/fixed_step.h"
#include "linear/vector_ops.h"

namespace tress::integrators {
namespace {

/// Order 1; amplifies oscillations for every h: a baseline.
class ExplicitEuler final : public FixedStep {
 public:
  ExplicitEuler(System& system, const Options& options) : FixedStep(system, options) {}

 private:
  Status step(double t, double h) override {
    const Status s = dynamics_.accelerate(t, q_, v_, a_, lambda_);
    if (s != Status::ok) return s;
    add(q_, h, v_);
    add(v_, h, a_);
    return Status::ok;
  }
};

}  // namespace

IntegratorEntry explicit_euler_entry() {
  return {.id = "explicit_euler",
          .summary = "amplifies; baseline",
          .source = "Euler 1768",
          .formulations = of_order(1, projected_formulations),
          .objection = inverts_mass,
          .make = make_method<ExplicitEuler>};
}

}  // namespace tress::integrators
