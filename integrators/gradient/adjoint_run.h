#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "integrators/gradient/pulled_parameters.h"
#include "integrators/gradient/recorded_run.h"
#include "integrators/gradient/transposed_equations.h"

namespace tress::integrators {

/// Why runs of this system have no adjoint; empty: they have, if they have a gradient.
std::string no_adjoint(System& system, std::string_view method, const Options& options);

/// A run and the exact derivatives of numbers of its motion by parameters, backward in
/// time: the discrete adjoint. The run records its stages. A sweep then goes back through
/// them, and each stage costs one linearization and for each number one solution with the
/// transposed matrix, however many the parameters are. The derivatives are those of
/// GradientRun, which cost less where the parameters are few and the numbers many.
///
/// With (q_hat, v_hat, ...) the derivatives of a number by what a stage has computed, and
/// q = q_bar + w.pos a, v = v_bar + w.vel a in r(q, v, a; s) = 0:
///
///     S^T mu = a_hat,   q_bar_hat -= r_q^T mu,   v_bar_hat -= r_v^T mu,   s_hat -= r_s^T
///     mu
///
/// What connects the stages is linear (StepTable) and is transposed.
class AdjointRun {
 public:
  /// A record longer than this is written in parts, for each of which a part of the run
  /// is repeated.
  static constexpr std::size_t most_record = std::size_t{64} << 20;  // bytes

  /// Takes the arguments of GradientRun.
  AdjointRun(System& system, std::unique_ptr<System> exact,
             std::span<const RunParameter> parameters, const GradientRun::Method& method,
             std::size_t record_bytes = most_record);

  /// Starts at t = 0 from initial_state().
  Status start();
  /// Advances to t_end and records the stages. Not `ok`: failure() gives the reason.
  Status advance(double t_end);
  /// Returns the time of the state, s.
  double time() const { return run_.time(); }
  /// Returns the coordinates (n).
  In q() const { return run_.q(); }
  /// Returns the rates (n).
  In v() const { return run_.v(); }

  /// Adds to x_hat, (3 points), the derivatives of a number by the points at a stop. Stop
  /// 0 is the start, stop k the end of the k-th advance().
  using Seed = std::function<void(std::size_t number, std::size_t stop, Out x_hat)>;
  /// Computes the derivatives of several numbers, (numbers x parameters).
  Status sweep(std::size_t numbers, const Seed& seed, Out by);

  /// Returns the reason of the last failure; empty if there was none.
  const std::string& failure() const { return failure_; }
  /// Whether sweep() failed since reference frames (History) moved during the run, which
  /// it does not differentiate. GradientRun does.
  bool frames_moved() const { return frames_moved_; }
  /// Returns the counters of the method in progress, without those of sweeps.
  const Stats& stats() const { return stats_; }
  /// Returns the size of the record in memory, bytes.
  std::size_t record_bytes() const;
  /// Returns the number of parts of the record.
  std::size_t parts() const { return parts_.size(); }

 private:
  struct Event {
    double t;
    bool begins;  // the method after a damped start
  };
  struct Part {
    std::size_t first;  // of events_
    RecordedRun::Place from;
  };
  struct Stop {
    std::size_t events;  // before it
    double t;
    std::vector<double> q;
  };
  /// Derivatives of one number by vectors of n.
  using Vectors = std::vector<std::vector<double>>;
  using Operation = StepTable::Operation;

  Status begin(std::size_t method, double t, In q, In v);
  Status advance_by(double t_end);
  Status advance_in(double count, double t_end);
  Status damped_start(double h);
  void note(Event event, const RecordedRun& run);
  void stop();
  Status fail(Status s, std::string why);
  Status frames_have_moved();
  Status repeat(std::size_t part);
  Status sweep_part(std::size_t part, const Seed& seed);
  void add_seeds(std::size_t events, const Seed& seed);
  void pull_back_points(const Stop& at, const Vectors& x_hat);
  void recall(In memory);
  Status step_back(const Tape::Step& step);
  Status back(const Operation& operation);
  void distribute(const StepTable::Combination& of, In x, Vectors& to) const;

  GradientRun::Method method_;
  System& system_;
  std::unique_ptr<System> exact_;
  std::size_t record_bytes_, n_;
  RecordedRun run_, again_;
  PulledParameters parameters_;
  TransposedEquations stages_;
  std::optional<TransposedEquations>
      starts_;  // with g'' = 0, where there are constraints
  bool damping_ = false, frames_moved_ = false;

  Tape tape_;
  std::vector<double> memory_;  // at the end of tape_, then during a sweep
  std::size_t on_tape_ = 0;     // of parts_
  std::vector<Event> events_;
  std::vector<Part> parts_;
  std::vector<Stop> stops_;

  // Of a sweep.
  std::size_t next_stop_ = 0;  // above those that have been added
  Tape::Motion motion_;
  std::vector<Vectors> hat_;     // by number: of the state
  std::vector<Vectors> inside_;  // by number: of the vectors of the step
  std::vector<std::vector<double>> x_;
  std::vector<double> q_hat_, v_hat_;
  std::string failure_;
  Stats stats_;
};

}  // namespace tress::integrators
