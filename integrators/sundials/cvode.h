#pragma once

#include "integrators/sundials/driver.h"
#include "integrators/sundials/first_order.h"

namespace tress::integrators {

/// Common base of CVODE's two families: the ODE form and the calls into the library.
class Cvode : public Driver {
 protected:
  /// `method`: CV_ADAMS or CV_BDF.
  Cvode(std::string_view id, System& system, const Options& options,
        std::span<const Formulation> formulations, int method, int order);

  int restart() override;
  int step(double t_end, double& t) override;
  Stats counters() const override;
  Stats work() const override { return equations_.work(); }
  std::string reason(int code) const override;
  Dynamics& dynamics() override { return equations_.rates(); }

  FirstOrder equations_;
  CvodeMemory memory_;
};

}  // namespace tress::integrators
