#include "integrators/entry.h"
#include "integrators/fixed_step.h"
#include "integrators/stage/stage.h"
#include "linear/vector_ops.h"

namespace tress::integrators {
namespace {

/// The one-stage Gauss method. Order 2, A-stable, no damping, symplectic:
/// a at t + h/2, (q_n + h/2 v_mid, v_mid = v_n + h/2 a); v += h a, q += h v_mid.
/// [Hairer, Lubich, Wanner: Geometric Numerical Integration, 2nd ed., II.1.3]
class ImplicitMidpoint final : public FixedStep {
 public:
  ImplicitMidpoint(System& system, const Options& options)
      : FixedStep(system, options), stage_(dynamics_, options), q_bar_(vector_n()) {}

 private:
  Status step(double t, double h) override {
    shifted(q_bar_, q_, h / 2, v_);
    stage_.leave(t, q_);
    const Status s =
        stage_.solve(t + h / 2, q_bar_, v_, {1, h / 2, h * h / 4}, a_, lambda_);
    add(q_, h, stage_.v());
    add(v_, h, a_);
    return s;
  }

  Stage stage_;
  std::vector<double> q_bar_;
};

}  // namespace

IntegratorEntry implicit_midpoint_entry() {
  return {.id = "implicit_midpoint",
          .summary = "A-stable, no damping, symplectic",
          .source = "Gauss 1 stage",
          .tangent = true,
          .stages = 1,
          .formulations = of_order(2, projected_formulations),
          .gaps = {{Formulation::index3, "Gauss methods are unstable on index 3"}},
          .make = make_method<ImplicitMidpoint>};
}

}  // namespace tress::integrators
