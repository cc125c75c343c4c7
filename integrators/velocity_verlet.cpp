#include "integrators/fixed_step.h"
#include "integrators/methods.h"
#include "integrators/vector_ops.h"

namespace tress {
namespace {

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

std::unique_ptr<Integrator> make_velocity_verlet(System& system, const Options& options) {
  return std::make_unique<VelocityVerlet>(system, options);
}

}  // namespace tress
