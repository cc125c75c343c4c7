#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "contract/integrator.h"
#include "integrators/formulation/dynamics.h"
#include "integrators/formulation/projection.h"

namespace tress::integrators {

/// The loop shared by every method with a fixed step: equal steps no longer than
/// Options::step that land on t_end, then projection if selected, System::accept and the
/// observer. A method writes step() and, when it has history, reset().
class FixedStep : public Integrator {
 public:
  /// Binds the method to a system, which must outlive it.
  FixedStep(System& system, const Options& options);

  Status start(double t, In q, In v) final;
  Status advance(double t_end, const Observer& each_step = {}) final;
  double time() const final { return t_; }
  In q() const final { return q_; }
  In v() const final { return v_; }
  Stats stats() const final { return dynamics_.stats; }
  std::string failure() const final { return failure_; }
  Limit limit() const final { return limit_; }
  /// Vectors of n on which the next step depends: q, v and what the method keeps of the
  /// motion before. A method that is started and given these and numbers() continues
  /// another's run up to the error of its equations.
  virtual std::vector<InOut> state() { return {q_, v_}; }
  /// Returns the single numbers on which the next step depends, such as the length of the
  /// last one.
  virtual std::vector<double*> numbers() { return {}; }

 protected:
  /// Forgets history; the state is q_, v_ at time t.
  virtual Status reset(double /*t*/) { return Status::ok; }
  /// After System::accept has changed coordinates or equations at time t. A method with
  /// memory carries it into the new coordinates (MovingHistory) where it can.
  virtual Status go_on_changed(double t) { return reset(t); }
  /// Moves q_, v_ from t to t + h.
  virtual Status step(double t, double h) = 0;

  /// q_ = q, v_ = v.
  void take(In q, In v);
  /// Takes the state at the end of a step of `stages`: q(), v(), a() and lambda().
  template <class Stages>
  void take_end(const Stages& stages) {
    take(stages.q(), stages.v());
    std::ranges::copy(stages.a(), a_.begin());
    std::ranges::copy(stages.lambda(), lambda_.begin());
  }
  /// Sets q_ = q, v_ = v between steps, after another caller has used the system.
  Status replace(In q, In v);

  std::vector<double> vector_n() const { return std::vector<double>(q_.size()); }

  Options options_;
  Dynamics dynamics_;
  std::vector<double> q_, v_;
  // (n), (m): the last acceleration and multipliers, guesses for the next ones; 0 at the
  // start.
  std::vector<double> a_, lambda_;

 private:
  /// Ends the run with `what` at time t as failure().
  Status end(Status status, double t, const std::string& what);
  /// Ends the run after a failed step; the message adds the number of the step and what
  /// was not finite.
  Status fail(Status status, double t, const std::string& what);
  Status finish_step(double t);

  std::optional<Projection> projection_;
  double t_ = 0;
  std::string failure_;
  Limit limit_ = Limit::none;
};

}  // namespace tress::integrators
