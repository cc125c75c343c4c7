#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "contract/integrator.h"
#include "integrators/gradient/rebound_delays.h"
#include "integrators/gradient/variational_system.h"

namespace tress::integrators {

/// Why a run has no derivative, and what to do.
struct NoGradient {
  std::string reason, remedy;  // in words, with the keys of scenes
};

/// Why the method has no derivative of its runs of this system; empty: it has. For fixed
/// steps: Options::tolerance is ignored.
std::optional<NoGradient> no_gradient(std::string_view method, System& system,
                                      const Options& options);

/// Start of a run: `as_run`, as the method starts it, or `damped`: with two steps of
/// backward Euler of a sixteenth of the step each. A parameter that moves the rest shape
/// out of the start excites stiff modes that the run itself does not have. Methods that
/// start from a0 = M^-1 f(q0, v0) carry them on. Measured on a straight hair let go
/// horizontally, 40 steps: its natural twist at the root moves the tip by 0.9 % of what
/// its natural curvature does. The exact derivative of the run gives 1600 times the
/// curvature's (tr_bdf2), 350 (newmark, generalized_alpha), 52 (esdirk43); with this
/// start 0.9 %. [Rannacher 1984, Numer. Math. 43, 309, for values of parabolic problems]
enum class GradientStart { as_run, damped };

/// A run with the exact derivatives of its states by parameters, forward in time: after
/// every step the same step of the variational equations (VariationalSystem). The run
/// itself is that of the landed method, bit by bit.
class GradientRun {
 public:
  /// Method of the run.
  struct Method {
    std::string_view id;                          // id of the integrator
    Options options;                              // Options::step: the longest step
    GradientStart start = GradientStart::as_run;  // treatment of the start
    int parts = 1;                                // of every step until the next stop
    KnownForces forces = {};                      // properties of the forces
  };

  /// `exact`: the same system, with the exact Jacobian. `copies`: as ResidualDerivative,
  /// which makes parameters cheaper. `system` must outlive this. Throws InputError where
  /// there is no_gradient().
  GradientRun(System& system, std::unique_ptr<System> exact,
              std::span<const RunParameter> parameters, const Method& method,
              std::unique_ptr<System> copies = nullptr);

  /// Starts at t = 0 from initial_state().
  Status start();
  /// A state on the way of a run of an equal system, and its derivatives there.
  struct State {
    double t = 0;                // time, s
    std::vector<double> q, v;    // coordinates and rates (n)
    std::vector<double> memory;  // System::memory()
    std::vector<double> dq, dv;  // parameter after parameter
  };
  /// Starts at such a state, with its memory and its derivatives.
  Status start(const State& from);
  /// Advances run and derivatives to t_end. Not `ok`: failure() tells why.
  Status advance(double t_end);
  /// Returns the time of the state, s.
  double time() const { return t_; }
  /// Returns the coordinates (n).
  In q() const { return q_; }
  /// Returns the rates (n).
  In v() const { return v_; }
  /// Derivatives of q and v by parameter k.
  In dq(std::size_t k) const { return In(dq_).subspan(k * q_.size(), q_.size()); }
  /// Returns the derivatives of v by parameter k.
  In dv(std::size_t k) const { return In(dv_).subspan(k * q_.size(), q_.size()); }
  /// Writes the derivatives of MaterialPoints::positions(), (3 count) m.
  void points_by(std::size_t k, Out dx);
  /// Returns the ends of the steps in which an exact contact opened, closed, came to rest
  /// or began to slide, s, in order.
  const std::vector<double>& contact_changes() const { return contact_changes_; }
  /// Returns what ended the last advance(); empty if it ended well.
  const std::string& failure() const { return failure_; }
  /// Steps and Newton iterations of the run; residuals, linearizations and solves of both
  /// the run and its derivatives, where one solve is that of all parameters.
  const Stats& stats() const { return stats_; }

 private:
  template <class Visit>
  void each_system(const Visit& visit);
  void forget();
  Status set_off();
  Status advance_by(Integrator& run, Integrator& columns, double t_end);
  Status advance_in(double count, double t_end);
  Status begin(std::string_view method, const Options& options);
  Status advance_columns(Integrator& columns, double t, In q, In v);
  Status shift_columns(Integrator& columns, double t, In q, In v, double sign);
  void keep(const Integrator& run, const Integrator& columns);
  Status fail(Status s, std::string why);

  Method method_;
  System& system_;
  std::unique_ptr<System> exact_, copies_;
  std::vector<VariedSystem> varied_;
  WatchedSystem watched_;
  VariationalSystem variational_;
  std::unique_ptr<Integrator> run_, columns_;
  std::optional<ReboundDelays> rebounds_;  // where points may rebound
  bool damping_ = false;                   // in the first steps
  double t_ = 0;
  std::vector<double> q_, v_, dq_, dv_;
  std::vector<ContactDerivative::Case> cases_;
  std::vector<double> contact_changes_;
  std::string failure_;
  Stats stats_, before_;  // before_: the present method
};

/// Returns the system. Throws InputError where its run by this method has no_gradient(),
/// or has a tolerance.
System& with_gradient(System& system, const GradientRun::Method& method);

}  // namespace tress::integrators
