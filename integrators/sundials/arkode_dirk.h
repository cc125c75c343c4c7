#pragma once

#include "integrators/sundials/driver.h"
#include "integrators/sundials/implicit_adapter.h"

namespace tress::integrators {

/// ARKODE's diagonally implicit Runge-Kutta methods on the ODE form, each stage solved
/// for the acceleration (ImplicitAdapter). By default ESDIRK4(3)6L[2]SA, stiffly accurate
/// and L-stable (Kennedy and Carpenter, NASA/TM-2016-219173). `table` selects any
/// SUNDIALS DIRK table by name; otherwise max_order 2 to 5 selects SUNDIALS' default of
/// that order. Reynolds et al., ARKODE, ACM TOMS 49(2), 2023.
class ArkodeDirk final : public Driver {
 public:
  /// Binds the method to a system, which must outlive it.
  ArkodeDirk(System& system, const Options& options);

 private:
  void choose_table();
  int restart() override;
  int step(double t_end, double& t) override;
  Stats counters() const override;
  Stats work() const override { return equations_.work(); }
  std::string reason(int code) const override;
  Dynamics& dynamics() override { return equations_.rates(); }

  FirstOrder equations_;
  ArkstepMemory memory_;
  ImplicitAdapter implicit_;
};

}  // namespace tress::integrators
