#include <vector>

#include "integrators/entry.h"
#include "integrators/fixed_step.h"
#include "integrators/position_based/position_sweeps.h"

namespace tress::integrators {
namespace {

constexpr Parameter xpbd_own[] = {sweeps_option, sweep_order_option, anderson_option};

/// Position-based dynamics with compliance: backward Euler on the energy, explicit on all
/// other forces. A fixed number of sweeps (PositionSweeps) starts from x = q + h v + h^2
/// rest(q, v); then v = (x - q)/h. Order 1. With few sweeps it is softer than the model,
/// increasingly so for longer steps and finer strands. Converged sweeps give backward
/// Euler's step except for the change of G during the step. That change is O(h^2) of the
/// force: none for linear C, large if light coordinates turn far. [Macklin, Mueller &
/// Chentanez 2016; Anderson 1965]
class Xpbd final : public FixedStep {
 public:
  Xpbd(System& system, const Options& options)
      : FixedStep(system, options),
        sweeps_(system, options, xpbd_own),
        form_(*system.compliance_form()),
        x_(vector_n()) {}

 private:
  Status step(double t, double h) override {
    if (const Status s = form_.rest(t, q_, v_, x_); s != Status::ok) return s;
    ++dynamics_.stats.residuals;
    for (std::size_t i = 0; i < x_.size(); ++i) x_[i] = q_[i] + h * (v_[i] + h * x_[i]);
    sweeps_.run(t + h, h, q_, x_, dynamics_.stats);
    for (std::size_t i = 0; i < x_.size(); ++i) v_[i] = (x_[i] - q_[i]) / h;
    q_.swap(x_);
    return Status::ok;
  }

  PositionSweeps sweeps_;
  ComplianceForm& form_;
  std::vector<double> x_;
};

}  // namespace

IntegratorEntry xpbd_entry() {
  return {.id = "xpbd",
          .summary = "position-based, Gauss-Seidel on compliances",
          .source = "Macklin-Mueller-Chentanez 2016",
          .formulations = {{Formulation::parametric, 1}},
          .gaps = gaps_of_sweeps(),
          .parameters = xpbd_own,
          .objection = compliances,
          .make = make_method<Xpbd>};
}

}  // namespace tress::integrators
