#include "integrators/entry.h"
#include "integrators/fixed_step.h"
#include "linear/vector_ops.h"

namespace tress::integrators {
namespace {

/// Verlet's method with g = 0 and g' = 0 enforced by impulses. Order 2, symplectic,
/// stable for h omega < 2; one factorisation per step. Needs a constant mass matrix.
/// [Andersen 1983, J. Comput. Phys. 52]
///
/// One step, with G_n the constraint gradient at q_n and [M, -G_n^T; G_n, 0] factored:
///     w = v_n + h/2 M^-1 (f_n + G_n^T lambda),  q_{n+1} = q_n + h w,  g(q_{n+1}) = 0
///     v_{n+1} = w + h/2 M^-1 (f_{n+1} + G_{n+1}^T mu),  G_{n+1} v_{n+1} + g_t = 0
/// The acceleration that satisfies g'' = 0 serves as the guess for both multipliers. The
/// remaining corrections are O(h^3) and O(h^2). f_{n+1} is evaluated at the predicted
/// velocity.
class Rattle final : public FixedStep {
 public:
  Rattle(System& system, const Options& options)
      : FixedStep(system, options),
        projection_(dynamics_),
        moved_(vector_n()),
        predicted_(vector_n()) {}

 private:
  Status reset(double t) override { return dynamics_.accelerate(t, q_, v_, a_, lambda_); }

  Status step(double t, double h) override {
    shifted(predicted_, v_, h, a_);
    add(v_, h / 2, a_);
    add(q_, h, v_);
    moved_ = q_;
    if (const Status s = projection_.positions(t + h, q_); s != Status::ok) return s;
    for (std::size_t i = 0; i < v_.size(); ++i) v_[i] += (q_[i] - moved_[i]) / h;
    const Status s = dynamics_.accelerate(t + h, q_, predicted_, a_, lambda_);
    if (s != Status::ok) return s;
    add(v_, h / 2, a_);
    return projection_.velocities(t + h, q_, v_);
  }

  Projection projection_;
  std::vector<double> moved_, predicted_;
};

}  // namespace

IntegratorEntry rattle_entry() {
  return {
      .id = "rattle",
      .summary = "symplectic, exact constraints",
      .source = "Andersen 1983",
      .formulations = {{Formulation::rattle, 2}},
      .gaps = holds_constraints("is velocity_verlet when there is nothing to constrain"),
      .objection = constant_mass,
      .make = make_method<Rattle>};
}

}  // namespace tress::integrators
