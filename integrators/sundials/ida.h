#pragma once

#include "integrators/sundials/dae_newton.h"
#include "integrators/sundials/driver.h"

namespace tress::integrators {

/// IDA: variable-order BDF (1 to 5) on the residual form, with constraints at index 1,
/// 2 (GGL) or 3. Multipliers stay out of the local error test (suppress_algebraic) and
/// have absolute tolerances multiplier_atol * atol times their typical size: without
/// both, GGL stalls. Initial y' and lambda come from the equations of motion.
///
/// Index 3 marks v as differential, i.e. keeps it under error control; this works only
/// for loose tolerances, where about half of the steps are repeated. Marking v algebraic
/// would run at any tolerance but leave the velocities uncontrolled.
///
/// refresh = every_step rebuilds whenever cj has changed; IDA offers no more than that.
/// Hindmarsh et al., SUNDIALS, ACM TOMS 31(3), 2005; Brenan, Campbell, Petzold, Numerical
/// Solution of Initial-Value Problems in DAEs, SIAM 1996, pp. 146-147.
class Ida final : public Driver {
 public:
  /// Binds the method to a system, which must outlive it.
  Ida(System& system, const Options& options);

 private:
  int restart() override;
  int step(double t_end, double& t) override;
  Stats counters() const override;
  Stats work() const override { return newton_->work(); }
  std::string reason(int code) const override;
  Dynamics& dynamics() override { return form_.dynamics; }

  DaeForm form_;
  std::unique_ptr<DaeNewton> newton_;
  SundialsVector y_dot_, id_;
  IdaMemory memory_;
  LinearAdapter linear_;
  double multiplier_atol_;
};

}  // namespace tress::integrators
