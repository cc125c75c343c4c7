#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "contract/forms/teleports.h"
#include "integrators/catalogue.h"
#include "models/motion/teleport.h"
#include "simulation/passages/body_depth.h"
#include "simulation/rest/supported_start.h"
#include "simulation/run/guards.h"
#include "simulation/run/metered.h"

namespace tress::simulation {

/// Returns the time from which a run goes on after a teleport on its way to `end`: there,
/// if only rounding lies between them.
inline double after_teleport(double teleport, double end) {
  return models::just_before(models::just_before(end)) <= teleport ? end : teleport;
}

/// Adds the work of one part of a run to that of the others.
void add_work(const Stats& from, Stats& to);

/// A system with the integrator that advances it and the guard that checks its steps: one
/// strand of a scene, or several that are one system.
///
/// A fixed step without a solution is divided into 2, 4 ... 64 shorter ones, after which
/// the scene's step resumes. This may happen a hundred times; beyond that, the step is
/// too long for the scene. stats().rejected counts every failed attempt.
struct SteppedSystem {
  /// Takes a system; an integrator and a guard may follow.
  explicit SteppedSystem(std::unique_ptr<System> made) : system(std::move(made)) {}

  std::unique_ptr<System> system;          // equations
  std::unique_ptr<Integrator> integrator;  // null before take_method()
  std::optional<Guards> guard;             // check of the steps; none: not checked
  std::optional<BodyDepth> depth;          // depth in bodies; none: no bodies
  SupportedStart supported;                // how it came onto its supports
  int parts = 1;                           // equal steps taken for each fixed step
  /// Effects of its first strand, of the second ...
  std::vector<std::shared_ptr<const Metered>> meters;

  Status status = Status::ok;  // result of the last advance()
  // The state after the last successful step.
  double t = 0;              // time, s
  std::vector<double> q, v;  // coordinates, rates
  double indicator = 0;      // largest error indicator so far

  /// The state of the model and an integrator at t = 0.
  struct State {
    std::vector<double> q, v, memory;  // memory: System::memory()
  };
  /// Why the guard has no account of what the method dissipates; empty: it has one.
  std::string no_dissipation() const;
  /// Returns the initial state.
  State initial_state() const;
  /// A new integrator, to be started.
  void take_method(std::string_view method, const Options& options);
  /// Starts from a state; the guard is not started.
  void start(double begin, State state);
  /// Advances to `end`, unless it has failed before. The guard also checks the last state
  /// if `last`, and where the integrator failed. At a teleport the method starts again
  /// from the state that was carried with the root.
  void advance(const IntegratorEntry& method, const Options& options, double end,
               bool last);
  /// Starts the method again from the kept state; its work so far counts.
  void restart(const IntegratorEntry& method, const Options& options, double at);
  /// Keeps the failed system at this state, at rest: readouts see it from now on.
  void stay(In at);
  /// q at the start of the last advance().
  In begun() const { return begun_; }
  /// Stores a state.
  void keep(double at, In new_q, In new_v);

  /// Returns true if the guard has found a violation.
  bool breached() const { return guard && guard->breach(); }
  /// Returns the reason of the failure: the guard's finding, or the integrator's message.
  /// Contains no remedy.
  std::string failure() const;
  /// The bound that ended it.
  Limit limit() const;
  /// Returns the counts since start().
  Stats stats() const;
  // What readouts see.
  /// Returns the coordinates that readouts see.
  In seen_q() const { return stays_ ? In(q) : integrator->q(); }
  /// Returns the rates that readouts see.
  In seen_v() const { return stays_ ? In(v) : integrator->v(); }
  /// Returns true if the system has failed and stays where it is.
  bool stays() const { return stays_; }

 private:
  void advance_between_teleports(const IntegratorEntry& method, const Options& options,
                                 double end, bool last);
  void teleport(const IntegratorEntry& method, const Options& options,
                Teleports& teleports, double at, double end);
  Status take_steps(double end, double h);
  double work_left(const Options& options) const;
  Status shorter_steps(const IntegratorEntry& method, const Options& options, double end);
  /// Stores every state and passes it to the guard.
  Observer observer();

  std::vector<double> begun_;
  Stats before_;            // work done before the integrator's last start
  double failed_work_ = 0;  // of shorter steps that failed, as total_work() counts it
  int shortened_ = 0;       // steps divided into shorter ones since start()
  bool gave_up_ = false;    // shorter steps did not help
  bool used_up_ = false;    // they took all of Options::max_work
  bool stays_ = false;
};

}  // namespace tress::simulation
