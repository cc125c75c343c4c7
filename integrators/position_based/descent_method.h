#pragma once

#include <vector>

#include "contract/forms/compliance_form.h"
#include "integrators/fixed_step.h"
#include "integrators/position_based/block_descent.h"

namespace tress::integrators {

/// Starting point of the sweeps of a step, from q, v and rest = a of a node.
enum class Start {
  inertial,  // q + h v + h^2 a
  adaptive   // q + h v + h^2 s a, s in [0, 1] the part of a in the last step's motion
};

/// Option that selects Start.
inline constexpr Parameter start_option{
    .name = "start",
    .help =
        "initial guess of the sweeps: under all other forces, or "
        "under the share of them in the acceleration of the last step",
    .choices = "inertial|adaptive"};

/// A backward Euler step by BlockDescent: x from the guess, v = (x - q)/h. All forces
/// that are not of the compliance form are explicit, as in xpbd. [Chen et al. 2024]
class DescentMethod final : public FixedStep {
 public:
  /// Binds the method to a system with a compliance form.
  DescentMethod(System& system, const Options& options, const DescentChoice& choice,
                Start start);

 private:
  Status reset(double t) override;
  Status step(double t, double h) override;
  void guess(double h);
  /// The part of a node's rest that the last step's acceleration had.
  double part(const std::vector<int>& node) const;

  BlockDescent descent_;
  ComplianceForm& form_;
  Start start_;
  double h_last_ = 0, ended_ = 0;
  bool begun_ = false;
  std::vector<double> x_, target_, rest_, v_last_;
};

}  // namespace tress::integrators
