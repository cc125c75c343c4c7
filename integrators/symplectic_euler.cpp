#include "integrators/fixed_step.h"
#include "integrators/methods.h"
#include "integrators/vector_ops.h"

namespace tress {
namespace {

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

std::unique_ptr<Integrator> make_symplectic_euler(System& system,
                                                  const Options& options) {
  return std::make_unique<SymplecticEuler>(system, options);
}

}  // namespace tress
