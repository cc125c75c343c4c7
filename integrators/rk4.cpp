#include "integrators/entry.h"
#include "integrators/fixed_step.h"
#include "linear/vector_ops.h"

namespace tress::integrators {
namespace {

/// The classical Runge-Kutta method. Order 4, stable for h omega < 2.83 on the imaginary
/// axis. [Kutta 1901]
class Rk4 final : public FixedStep {
 public:
  Rk4(System& system, const Options& options)
      : FixedStep(system, options),
        q_stage_(vector_n()),
        v_stage_(vector_n()),
        q_sum_(vector_n()),
        v_sum_(vector_n()) {}

 private:
  Status step(double t, double h) override {
    constexpr double node[] = {0, 0.5, 0.5, 1};
    constexpr double weight[] = {1. / 6, 1. / 3, 1. / 3, 1. / 6};
    q_sum_ = q_;
    v_sum_ = v_;
    q_stage_ = q_;
    v_stage_ = v_;
    for (int i = 0; i < 4; ++i) {
      const Status s =
          dynamics_.accelerate(t + node[i] * h, q_stage_, v_stage_, a_, lambda_);
      if (s != Status::ok) return s;
      add(q_sum_, weight[i] * h, v_stage_);
      add(v_sum_, weight[i] * h, a_);
      if (i == 3) break;
      for (std::size_t j = 0; j < q_.size(); ++j) {
        q_stage_[j] = q_[j] + node[i + 1] * h * v_stage_[j];
        v_stage_[j] = v_[j] + node[i + 1] * h * a_[j];
      }
    }
    q_ = q_sum_;
    v_ = v_sum_;
    return Status::ok;
  }

  std::vector<double> q_stage_, v_stage_, q_sum_, v_sum_;
};

}  // namespace

IntegratorEntry rk4_entry() {
  return {.id = "rk4",
          .summary = "conditionally stable",
          .source = "Kutta 1901",
          .formulations = of_order(4, projected_formulations),
          .objection = inverts_mass,
          .make = make_method<Rk4>};
}

}  // namespace tress::integrators
