#pragma once

#include "integrators/sundials/driver.h"
#include "integrators/sundials/first_order.h"

namespace tress::integrators {

/// ARKODE's explicit embedded Runge-Kutta pairs on the ODE form, one of SUNDIALS'
/// defaults by order: max_order 2 to 8, 5 by default (Cash-Karp 5(4)). The step is
/// limited by the fastest mode. Reynolds et al., ARKODE, ACM TOMS 49(2), 2023.
///
/// ERKStep ends the run when the model requests a smaller step; recover() restarts it
/// with one.
class ArkodeErk final : public Driver {
 public:
  /// Binds the method to a system, which must outlive it.
  ArkodeErk(System& system, const Options& options);

 private:
  int restart() override;
  int step(double t_end, double& t) override;
  bool recover(int code) override;
  Stats counters() const override;
  Stats work() const override { return equations_.work(); }
  std::string reason(int code) const override;
  Dynamics& dynamics() override { return equations_.rates(); }

  FirstOrder equations_;
  ErkstepMemory memory_;
};

}  // namespace tress::integrators
