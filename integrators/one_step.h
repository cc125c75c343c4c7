#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "integrators/control/error_controlled.h"
#include "integrators/fixed_step.h"
#include "integrators/stage/unknowns.h"

/// Runs of a one-step method with a fixed step or a tolerance. Such a Method is made of
/// (Dynamics&, const Options&, more...) and has
///
///     Status step(double t, double h, In q, In v, In a, In lambda, Effort effort)
///     In q() const, v() const, a() const, lambda() const   the end of the last step
///     Status difference(Out dq, Out dv)                     its estimated error
///     void forget()            the next step does not continue the last one
namespace tress::integrators {

/// Returns t plus rounding errors of times: the side of a breakpoint on which a step
/// starts.
inline double just_after(double t) {
  constexpr double rounding = 8 * std::numeric_limits<double>::epsilon();
  return std::nextafter(t + rounding * std::abs(t),
                        std::numeric_limits<double>::infinity());
}

/// A run with a fixed step.
template <class Method>
class FixedOneStep final : public FixedStep {
 public:
  /// Passes `more` to the method.
  template <class... More>
  FixedOneStep(System& system, const Options& options, const More&... more)
      : FixedStep(system, options), method_(dynamics_, options, more...) {}

  std::vector<InOut> state() override { return {q_, v_, a_}; }

 private:
  Status reset(double t) override {
    method_.forget();
    breaks_ = dynamics_.system().next_breakpoint(t);
    return dynamics_.accelerate(just_after(t), q_, v_, a_, lambda_);
  }

  Status step(double t, double h) override {
    // The acceleration may have jumped.
    if (just_after(t) >= breaks_) {
      if (const Status s = reset(just_after(t)); s != Status::ok) return s;
    }
    const Status s = method_.step(t, h, q_, v_, a_, lambda_, Effort::whole);
    if (s != Status::ok) return s;
    take_end(method_);
    return s;
  }

  Method method_;
  double breaks_ = 0;  // the next breakpoint
};

/// A run with Options::tolerance.
template <class Method>
class ControlledOneStep final : public ErrorControlled {
 public:
  /// The estimate falls as h^`power` and shall be at most `threshold`; `within` are the
  /// options of the method.
  template <class... More>
  ControlledOneStep(System& system, const Options& options, int power, double threshold,
                    const Options& within, const More&... more)
      : ErrorControlled(system, options, power, threshold),
        method_(dynamics(), within, more...),
        restart_(dynamics()) {}

 private:
  Status try_step(const State& from, double h, Effort effort, State& to, Out error_q,
                  Out error_v) override {
    if (restarts_) {  // on the right side of a breakpoint
      t_restart_ = from.t;
      const Status s = dynamics().accelerate(just_after(from.t), from.q, from.v,
                                             restart_.a, restart_.lambda);
      if (s != Status::ok) return s;
      restarts_ = false;
    }
    const bool restart = from.t == t_restart_;
    const Status s =
        method_.step(from.t, h, from.q, from.v, restart ? restart_.a : from.a,
                     restart ? restart_.lambda : from.lambda, effort);
    if (s != Status::ok) return s;
    to.take_end(method_);
    return method_.difference(error_q, error_v);
  }
  void forget_steps() override {
    restarts_ = true;
    method_.forget();
  }

  Method method_;
  bool restarts_ = true;
  double t_restart_ = 0;
  Unknowns restart_;  // at t_restart_
};

}  // namespace tress::integrators
