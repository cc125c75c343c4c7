#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "contract/integrator.h"
#include "integrators/control/error_norm.h"
#include "integrators/control/rewindable.h"
#include "integrators/control/step_control.h"
#include "integrators/formulation/dynamics.h"
#include "integrators/formulation/projection.h"
#include "integrators/stage/effort.h"

namespace tress::integrators {

/// Loop of every method that chooses its steps so that the estimated error of each stays
/// below a threshold (ErrorNorm). A method implements try_step().
///
/// Steps need not end where advance() does. The state there is interpolated by a quintic
/// polynomial through (q, v, a) at both ends of the step, with error O(h^6).
/// Interpolation precedes System::accept for the step's end, which may change the meaning
/// of coordinates. The state is projected onto the constraints where the method projects.
/// The polynomial does not preserve the length of a stiff strand. Where it stretches the
/// strand, the step is repeated to end at t_end, and so are later steps of that length
/// (fails_from_). The system must not be changed from outside between two calls of
/// advance(), except before rewind().
///
/// Step control: StepControl. Where Newton's iteration fails, shorter steps are tried
/// first because they are cheap. If several fail too, the first step is tried again with
/// all methods of Stage, then shorter ones in the same way.
class ErrorControlled : public Integrator, public Rewindable {
 public:
  Status start(double t, In q, In v) final;
  Status advance(double t_end, const Observer& each_step = {}) final;
  double time() const final { return t_; }
  In q() const final { return q_; }
  In v() const final { return v_; }
  Stats stats() const final { return dynamics_.stats; }
  std::string failure() const final { return failure_; }
  Limit limit() const final { return limit_; }
  void mark() final;
  void rewind() final;

 protected:
  /// The estimate falls as h^`power` and shall be at most `threshold` in a step.
  ErrorControlled(System& system, const Options& options, int power, double threshold);

  /// One end of a step.
  struct State {
    /// Allocates for n coordinates and m multipliers.
    State(std::size_t n, std::size_t m) : q(n), v(n), a(n), lambda(m) {}
    double t = 0;                 // time, s
    std::vector<double> q, v, a;  // coordinates, rates, accelerations
    std::vector<double> lambda;   // multipliers
    /// Copies the end of a step of `stages`: q(), v(), a() and lambda().
    template <class Stages>
    void take_end(const Stages& stages) {
      std::ranges::copy(stages.q(), q.begin());
      std::ranges::copy(stages.v(), v.begin());
      std::ranges::copy(stages.a(), a.begin());
      std::ranges::copy(stages.lambda(), lambda.begin());
    }
  };

  /// Takes a trial step from `from` over h to `to`, with the estimated errors of q and v.
  /// Returns `retry` if no solution was found with this effort.
  virtual Status try_step(const State& from, double h, Effort effort, State& to,
                          Out error_q, Out error_v) = 0;
  /// The next step does not go on from the last one: nothing may be guessed from it.
  virtual void forget_steps() = 0;

  Dynamics& dynamics() { return dynamics_; }

  /// Speed (m/s) of a point whose error is as large as one step may have.
  double seen_speed() const { return threshold_ * norm_.typical_speed(); }
  /// Returns the time (s) in which the body falls about its own size.
  double typical_time() const { return norm_.typical_time(); }

 private:
  Status end_run(Status status, const std::string& what);
  /// Ends the run after a step that cannot be taken; the message adds the number of the
  /// step and what was not finite.
  Status fail(Status status, const std::string& what);
  /// Forgets history at begin_.
  Status restart();
  /// Finds the next step: end_. A step as long as those whose polynomial failed ends at
  /// `t_end` at the latest.
  Status next_step(double t_end);
  /// Attempts at one step.
  struct Attempts {
    Effort effort = Effort::plain;
    int plain = 0;       // without a solution
    StepControl before;  // as it was then at first
  };
  /// After a plain attempt found none: a shorter step, or the first one with more effort.
  void without_solution(const StepControl::Trial& failed, Attempts& attempts);
  /// After Newton's iteration failed, in a stage or in the projection.
  Status unsolved(const StepControl::Trial& failed);
  /// Fails where the next step is too short after a rejection for `reason`.
  Status shortened(const std::string& reason);
  void accept_end();
  void interpolate(double t);
  /// The state at t_end inside the step; false: the polynomial failed there.
  bool read(double t_end);
  /// Goes back to the start of a step whose polynomial failed.
  void give_back();

  Options options_;
  Dynamics dynamics_;
  ErrorNorm norm_;
  std::optional<Projection> projection_;
  double power_, threshold_;
  StepControl control_;
  double t_ = 0;
  std::vector<double> q_, v_;  // at t_
  State begin_, end_;          // of the step around t_
  bool ahead_ = false;         // end_ is beyond t_ and not accepted yet
  bool at_break_ = false;      // end_ is where the equations are not smooth
  bool stale_ = false;         // begin_.a is of equations that do not hold any more
  double fails_from_ = 0;      // length of the last step whose polynomial failed
  std::vector<double> error_q_, error_v_;
  /// State that rewind() restores.
  struct Mark {
    double t;
    std::vector<double> q, v;
    StepControl control;
    long steps;
  };
  std::optional<Mark> mark_;
  std::string failure_ = "not started";
  Limit limit_ = Limit::none;
};

}  // namespace tress::integrators
