#include "integrators/control/impulsive.h"
#include "integrators/entry.h"
#include "integrators/fixed_step.h"
#include "integrators/stage/stage.h"
#include "linear/vector_ops.h"

namespace tress::integrators {
namespace {

/// v_{n+1} = v_n + h a_{n+1}, q_{n+1} = q_n + h v_{n+1}. The last acceleration is the
/// initial guess. Order 1, L-stable, strongly damping. [Hairer, Wanner: Solving ODEs II,
/// IV.3]
class BackwardEuler final : public FixedStep, public Impulsive {
 public:
  BackwardEuler(System& system, const Options& options)
      : FixedStep(system, options), stage_(dynamics_, options), q_bar_(vector_n()) {}

 private:
  Status go_on(In q, In v) override { return replace(q, v); }
  void lose_matrix() override { dynamics_.lose_matrix(); }

  Status step(double t, double h) override {
    shifted(q_bar_, q_, h, v_);
    stage_.leave(t, q_);
    stage_.places(t, q_, v_, stage_.place_bar());
    const Status s = stage_.solve(t + h, q_bar_, v_, {1, h, h * h}, a_, lambda_);
    take(stage_.q(), stage_.v());
    return s;
  }

  Stage stage_;
  std::vector<double> q_bar_;
};

}  // namespace

IntegratorEntry backward_euler_entry() {
  return {.id = "backward_euler",
          .summary = "L-stable, strong damping",
          .source = "Hairer-Wanner IV.3",
          .impulsive = true,
          .tangent = true,
          .stages = 1,
          .contact = Contact::exact_rebounding,
          .formulations = of_order(1, stage_formulations),
          .make = make_method<BackwardEuler>};
}

}  // namespace tress::integrators
