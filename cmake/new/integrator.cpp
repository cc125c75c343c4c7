// FILL IN: what this method is, in one sentence.
#include "contract/fill_in.h"
#include "integrators/entry.h"
#include "integrators/fixed_step.h"
#include "integrators/stage/stage.h"
#include "linear/vector_ops.h"

namespace tress::integrators {
namespace {

/// FILL IN: the formula, its order and stability, and the source with equation numbers.
///
///     q_{n+1} = q_bar + w.pos a_{n+1},   v_{n+1} = v_bar + w.vel a_{n+1}
///
/// Stage solves the equations of motion at the end of the step for a_{n+1}.
class Method final : public FixedStep {
 public:
  Method(System& system, const Options& options)
      : FixedStep(system, options),
        stage_(dynamics_, options),
        q_bar_(vector_n()),
        v_bar_(vector_n()) {}

 private:
  /// FILL IN: q_bar_ and v_bar_ from q_ and v_, the state at the start of the step of
  /// length h. Returns the weights {1, w.vel, w.pos}. shifted() and add() of
  /// linear/vector_ops.h do the sums. a_ is the acceleration of the last solve, 0 in the
  /// first step. If the formula needs that of the start, override reset() with
  /// dynamics_.accelerate(), and state() to return a_ too.
  Weights known_part(double /*h*/) {
    fill_in("q_bar_, v_bar_ and the weights of the stage");
  }

  Status step(double t, double h) override {
    const Weights w = known_part(h);
    stage_.leave(t, q_);
    const Status s = stage_.solve(t + h, q_bar_, v_bar_, w, a_, lambda_);
    take(stage_.q(), stage_.v());
    return s;
  }

  Stage stage_;
  std::vector<double> q_bar_, v_bar_;
};

constexpr int order = 1;  // FILL IN: errors fall with this power of the step

}  // namespace

IntegratorEntry skeleton_name_entry() {
  return {.id = "skeleton_name",
          .summary = "FILL IN: stability and damping, one line",
          .source = "FILL IN: author year",
          .tangent = true,
          .stages = 1,
          .formulations = of_order(order, stage_formulations),
          .make = make_method<Method>};
}

}  // namespace tress::integrators
