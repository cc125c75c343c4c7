#include "integrators/entry.h"
#include "integrators/fixed_step.h"
#include "linear/vector_ops.h"

namespace tress::integrators {
namespace {

/// v += h a(q, v), q += h v. Order 1, symplectic for separable systems, stable for
/// h omega < 2. [Hairer, Lubich, Wanner: Geometric Numerical Integration, 2nd ed.,
/// VI.3.1]
class SymplecticEuler final : public FixedStep {
 public:
  SymplecticEuler(System& system, const Options& options) : FixedStep(system, options) {}

 private:
  Status step(double t, double h) override {
    const Status s = dynamics_.accelerate(t, q_, v_, a_, lambda_);
    if (s != Status::ok) return s;
    add(v_, h, a_);
    add(q_, h, v_);
    return Status::ok;
  }
};

}  // namespace

IntegratorEntry symplectic_euler_entry() {
  return {.id = "symplectic_euler",
          .summary = "symplectic, conditionally stable",
          .source = "Hairer-Lubich-Wanner VI.3",
          .formulations = of_order(1, projected_formulations),
          .objection = inverts_mass,
          .make = make_method<SymplecticEuler>};
}

}  // namespace tress::integrators
