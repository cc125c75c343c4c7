#include <algorithm>

#include "integrators/fixed_step.h"
#include "integrators/methods.h"
#include "integrators/stage.h"
#include "integrators/vector_ops.h"

namespace tress {
namespace {

/// S(1, h, h^2) a = -r(a = 0) at (q_n + h v_n, v_n); v += h a, q += h v. S is taken at
/// the last acceleration, none at the start: at a = 0 an exact tangent has the geometric
/// stiffness of a strand that does not accelerate, and a shaken one is then less stable
/// than without any.
class SemiImplicitEuler final : public FixedStep {
 public:
  SemiImplicitEuler(System& system, const Options& options)
      : FixedStep(system, options),
        stage_(dynamics_, options),
        a_(vector_n()),
        a_last_(vector_n()),
        q_bar_(vector_n()) {}

 private:
  Status reset(double /*t*/) override {
    std::ranges::fill(a_, 0.0);
    return Status::ok;
  }

  Status step(double t, double h) override {
    shifted(q_bar_, q_, h, v_);
    std::swap(a_, a_last_);
    std::ranges::fill(a_, 0.0);
    const Status s =
        stage_.single_step(t + h, q_bar_, v_, {1, h, h * h}, a_last_, a_, lambda_);
    take(stage_.q(), stage_.v());
    return s;
  }

  Stage stage_;
  std::vector<double> a_, a_last_, q_bar_;
};

}  // namespace

std::unique_ptr<Integrator> make_semi_implicit_euler(System& system,
                                                     const Options& options) {
  return std::make_unique<SemiImplicitEuler>(system, options);
}

}  // namespace tress
