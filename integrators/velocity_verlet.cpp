#include "integrators/entry.h"
#include "integrators/fixed_step.h"
#include "linear/vector_ops.h"

namespace tress::integrators {
namespace {

/// Half kick, drift, half kick. Order 2, symplectic for separable systems, stable for
/// h omega < 2. Velocity-dependent forces are evaluated at the predicted v + h a, which
/// keeps order 2 with one evaluation per step. [Swope et al. 1982, J. Chem. Phys. 76,
/// 637]
class VelocityVerlet final : public FixedStep {
 public:
  VelocityVerlet(System& system, const Options& options)
      : FixedStep(system, options), predicted_(vector_n()) {}

 private:
  Status reset(double t) override { return dynamics_.accelerate(t, q_, v_, a_, lambda_); }

  Status step(double t, double h) override {
    predicted_ = v_;
    add(predicted_, h, a_);
    add(v_, h / 2, a_);
    add(q_, h, v_);
    const Status s = dynamics_.accelerate(t + h, q_, predicted_, a_, lambda_);
    add(v_, h / 2, a_);
    return s;
  }

  std::vector<double> predicted_;
};

}  // namespace

IntegratorEntry velocity_verlet_entry() {
  return {.id = "velocity_verlet",
          .summary = "symplectic, conditionally stable",
          .source = "Swope 1982",
          .formulations = of_order(2, projected_formulations),
          .objection = inverts_mass,
          .make = make_method<VelocityVerlet>};
}

}  // namespace tress::integrators
