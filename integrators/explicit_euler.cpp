#include "integrators/fixed_step.h"
#include "integrators/methods.h"
#include "integrators/vector_ops.h"

namespace tress {
namespace {

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

std::unique_ptr<Integrator> make_explicit_euler(System& system, const Options& options) {
  return std::make_unique<ExplicitEuler>(system, options);
}

}  // namespace tress
