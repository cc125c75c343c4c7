#include "integrators/fixed_step.h"
#include "integrators/methods.h"
#include "integrators/semi_implicit_step.h"

namespace tress {
namespace {

class SemiImplicitEuler final : public FixedStep {
 public:
  SemiImplicitEuler(System& system, const Options& options)
      : FixedStep(system, options), step_(dynamics_, options) {}

 private:
  Status reset(double /*t*/) override {
    step_.reset();
    return Status::ok;
  }

  Status step(double t, double h) override {
    const Status s = step_.take(t, h, q_, v_, lambda_);
    take(step_.q(), step_.v());
    return s;
  }

  SemiImplicitStep step_;
};

}  // namespace

std::unique_ptr<Integrator> make_semi_implicit_euler(System& system,
                                                     const Options& options) {
  return std::make_unique<SemiImplicitEuler>(system, options);
}

}  // namespace tress
