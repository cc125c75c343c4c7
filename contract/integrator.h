#pragma once

#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include "contract/linear_kind.h"
#include "contract/parameters.h"
#include "contract/system.h"

namespace tress {

/// Form of the constraints in the equations (shared by all integrators; see
/// formulation/).
enum class Formulation {
  parametric,    // the model's coordinates satisfy the constraints, or it has none
  acceleration,  // g'' = 0: index 1, drifts
  baumgarte,     // g'' = -alpha g - beta g': index 1 with feedback
  projection,    // g'' = 0, then q and v are projected after each step
  index2_ggl,  // g = 0 and g' = 0 with a second multiplier (Gear, Gupta, Leimkuhler 1985)
  index3,      // g = 0 without index reduction
  rattle,      // g = 0 and g' = 0 by half-step impulses (Andersen 1983)
  correction,  // unconstrained step, then q is moved onto g = 0 (Provot 1995)
};
/// Returns the name of a formulation, as options and tables have it.
std::string_view name(Formulation formulation);

/// When an implicit method rebuilds its Newton matrix: in `every_iteration`, in
/// `every_step`, or `when_slow`: once corrections shrink too slowly.
enum class Refresh { every_iteration, every_step, when_slow };

/// Options of all integrators; each reads those that apply to it. `apply` in
/// integrators/integrator_options.h sets any of them from text.
struct Options {
  Formulation formulation = Formulation::parametric;  // form of the constraints
  double alpha = 0;                                   // 1/s^2, Baumgarte's position gain
  double beta = 0;                                    // 1/s, Baumgarte's velocity gain

  double step = 1e-3;           // s, fixed-step methods
  double rtol = 1e-6;           // adaptive methods
  double atol = 1e-8;           // adaptive methods, times System::scale
  double max_step = 0;          // s, 0: unlimited
  double tolerance = 0;         // of the length, error-controlled methods; 0: fixed step
  double min_step = 0;          // s, with a tolerance: a run that needs less fails
  long max_steps = 10'000'000;  // per advance; beyond it the run fails
  double max_work = 0;          // since start(), as total_work() counts it; 0: unlimited

  int max_order = 0;  // multistep order or Runge-Kutta order; 0: the method's default

  double newton_tolerance = 1e-10;             // largest correction over System::scale
  int newton_iterations = 20;                  // bound of the corrections of one solution
  Refresh refresh = Refresh::every_iteration;  // rebuilds of Newton's matrix
  double contact_tolerance = 1e-8;  // m/s, ContactForm::improve() at the end of a stage
  /// Bound of the improvements of multipliers at the end of a stage.
  int contact_iterations = 30;
  /// IDA, CVODE, ARKODE: Newton tolerance relative to the error test. SUNDIALS' own
  /// defaults (0.33, 0.1, 0.1; selected by 0) leave stale-matrix errors that break the
  /// error test: on the pendulum 1e-2 is both more accurate and faster.
  double newton_coefficient = 1e-2;

  LinearKind linear = LinearKind::automatic;  // linear solver of Newton's equations

  /// Method-specific options, as text by name; read by own_options().
  std::map<std::string, std::string, std::less<>> own;
};

/// Values of a method's own options: the declared defaults, overridden by `options`.
Parameters own_options(const Options& options, std::span<const Parameter> declared);

/// Work done since start(); counts that do not apply to a method stay zero.
struct Stats {
  long steps = 0;              // accepted steps
  long rejected = 0;           // error-test and convergence failures that repeated a step
  long residuals = 0;          // evaluations of System::residual
  long linearizations = 0;     // matrices that were built and factored
  long solves = 0;             // solutions with such a matrix
  long newton_iterations = 0;  // corrections of Newton's method
  long sweeps = 0;             // over constraints solved one at a time
  // Of `rejected`, by methods that tell them apart.
  long rejected_by_error = 0;   // steps rejected by the estimated error
  long rejected_by_newton = 0;  // steps rejected since Newton's method did not converge
  long replaced = 0;            // accepted backward Euler steps in place of the method's
  double smallest_step = 0;     // s, that error control chose; 0: it chose none
  double smallest_step_at = 0;  // s
  /// Cause of that step: "start", "error" or "newton".
  std::string_view smallest_step_cause = "";
  std::string_view solver = "none";  // linear solver in use
  int rank_deficiency = 0;           // redundant constraints found and handled
  double condition = 0;              // largest condition estimate; 0: not estimated
  // Of exact contact: solutions and improvements of the multipliers, stages that ended
  // short of Options::contact_tolerance, and the largest violation of the law there.
  long contact_iterations = 0;   // solutions with exact contact
  long contact_unfinished = 0;   // stages that ended short of Options::contact_tolerance
  double contact_violation = 0;  // m/s
};

/// Clock-independent cost of a run: every residual, matrix, solve, sweep and step counts
/// n + 10 for n coordinates. A million takes 0.01 to 0.4 s, about 3 s with a dense
/// tangent.
inline double total_work(const Stats& done, int coordinates) {
  const long calls =
      done.residuals + done.linearizations + done.solves + done.sweeps + done.steps;
  return static_cast<double>(calls) * (coordinates + 10.0);
}

/// Whether a run of n coordinates has reached Options::max_work.
inline bool work_used_up(const Options& options, const Stats& done, int coordinates) {
  return options.max_work > 0 && total_work(done, coordinates) >= options.max_work;
}

/// The bound of Options that ended a run: max_steps (`steps`), max_work (`work`) or
/// `none`.
enum class Limit { none, steps, work };

/// Called after every accepted step; returning false stops the run (Status::fatal,
/// "stopped").
using Observer = std::function<bool(double t, In q, In v)>;

/// One method bound to one system. The system must outlive it and must not be shared
/// meanwhile.
class Integrator {
 public:
  virtual ~Integrator() = default;

  /// Sets the initial state; may be called again. The state need not satisfy the
  /// constraints (recovery from violation is an experiment).
  virtual Status start(double t, In q, In v) = 0;

  /// Advances to t_end exactly. Not `ok`: failure() reports what happened and when.
  virtual Status advance(double t_end, const Observer& each_step = {}) = 0;

  /// Returns the time of the state, s.
  virtual double time() const = 0;
  /// Returns the coordinates (n); valid until the next call.
  virtual In q() const = 0;
  /// Returns the rates (n); valid until the next call.
  virtual In v() const = 0;
  /// Returns the work done since start().
  virtual Stats stats() const = 0;
  /// Returns what ended the last advance() and when; empty if it ended well.
  virtual std::string failure() const = 0;
  /// After a failure: the bound that was reached; none if the method itself failed.
  virtual Limit limit() const = 0;
};

}  // namespace tress
