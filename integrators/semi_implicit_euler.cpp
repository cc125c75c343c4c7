#include <algorithm>

#include "integrators/fixed_step.h"
#include "integrators/methods.h"
#include "integrators/stage.h"
#include "integrators/vector_ops.h"

namespace tress {
namespace {

/// S(1, h, h^2) a = f - r(a = 0) at (q_n + h v_n, v_n); v += h a, q += h v.
class SemiImplicitEuler final : public FixedStep {
 public:
  SemiImplicitEuler(System& system, const Options& options)
      : FixedStep(system, options),
        stage_(dynamics_, options),
        a_(vector_n()),
        q_bar_(vector_n()) {}

 private:
  Status step(double t, double h) override {
    shifted(q_bar_, q_, h, v_);
    std::fill(a_.begin(), a_.end(), 0.0);
    const Status s = stage_.single_step(t + h, q_bar_, v_, {1, h, h * h}, a_, lambda_);
    take(stage_.q(), stage_.v());
    return s;
  }

  Stage stage_;
  std::vector<double> a_, q_bar_;
};

}  // namespace

std::unique_ptr<Integrator> make_semi_implicit_euler(System& system,
                                                     const Options& options) {
  return std::make_unique<SemiImplicitEuler>(system, options);
}

}  // namespace tress
