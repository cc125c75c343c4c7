#pragma once

#include <span>

#include "contract/integrator.h"
#include "integrators/formulation/dynamics.h"
#include "integrators/sundials/sundials.h"

namespace tress::integrators {

/// Common base of all SUNDIALS integrators. The state y = (q, v, ...) is in memory of
/// tress, with absolute tolerances atol * System::scale. The driver takes one internal
/// step at a time, with the end of the interval as stop time. System::accept and the
/// observer follow each step. Failures are reported as text.
///
/// Options.refresh: SUNDIALS never rebuilds inside a step. `every_step` forces a rebuild
/// in each. The other two leave SUNDIALS' own rule: rebuild when gamma or cj has drifted,
/// when convergence is slow, or after 20 steps at the latest.
class Driver : public Integrator {
 public:
  Status start(double t, In q, In v) final;
  Status advance(double t_end, const Observer& each_step) final;
  double time() const final { return time_; }
  In q() const final { return y_.values().first(n_); }
  In v() const final { return y_.values().subspan(n_, n_); }
  Stats stats() const final;
  std::string failure() const final { return failure_; }
  Limit limit() const final { return limit_; }

 protected:
  /// `unknowns` beyond q and v follow them in y.
  Driver(std::string_view id, System& system, const Options& options,
         std::span<const Formulation> formulations, int unknowns);

  /// Restarts at (time_, y_); returns SUNDIALS' code.
  virtual int restart() = 0;
  /// One internal step into y_ that does not pass t_end.
  virtual int step(double t_end, double& t) = 0;
  /// After a failed step, with y_ back at the last good state: true when the method has
  /// restarted there with a smaller step.
  virtual bool recover(int /*code*/) { return false; }
  /// Rejected steps since the last restart(), and Newton iterations if the library counts
  /// them.
  virtual Stats counters() const = 0;
  /// Residuals, linearizations, solves and Newton iterations that we count, since
  /// construction, and the solver.
  virtual Stats work() const = 0;
  virtual std::string reason(int code) const = 0;
  /// The equations of motion, which report what was not finite.
  virtual Dynamics& dynamics() = 0;

  const Options options_;
  SundialsContext context_;
  SundialsVector y_, atol_;
  double time_ = 0;

 private:
  Status fail(const std::string& why);
  /// Ends the run as fail() does; the message adds the number of the step and what was
  /// not finite in it.
  Status fail_in_step(std::string why);
  Status fail_with(int code);
  Status begin();
  Stats added_counters() const;

  const std::string id_;
  System& system_;
  const std::size_t n_;
  std::vector<double> last_;  // y after the last good step
  long steps_ = 0;
  bool restarted_ = true;  // no step since: ARKODE has not reset its counters yet
  Stats carried_;          // counters accumulated before the last restart
  Stats work_before_;      // work() at start()
  std::string failure_ = "not started";
  Limit limit_ = Limit::none;
};

/// Options.max_order if it is within [1, most], `standard` if it is 0, else InputError.
int chosen_order(std::string_view id, const Options& options, int standard, int least,
                 int most);

}  // namespace tress::integrators
