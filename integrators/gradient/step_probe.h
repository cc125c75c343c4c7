#pragma once

#include <array>
#include <memory>
#include <vector>

#include "contract/forms/explicit_form.h"
#include "contract/forms/moving_history.h"
#include "integrators/fixed_step.h"
#include "integrators/gradient/watched_system.h"

namespace tress::integrators {

/// One step of a method, or its start, as a program. The vectors of a step are first its
/// inputs (FixedStep::state(), or q and v at a start), then the results of operations in
/// their order. Everything else in a step is linear algebra on these vectors that is the
/// same for every coordinate.
struct StepTable {
  /// Vector of the step times a factor.
  struct Term {
    std::size_t vector;  // index among the vectors of the step
    double factor;       // factor of the vector
  };
  /// Sum of terms: a linear combination of the vectors of the step.
  using Combination = std::vector<Term>;

  /// Nonlinear part of a step, from combinations of earlier vectors to new vectors.
  struct Operation {
    /// Kind of operation. A stage finds a with r(q + w.pos a, v + w.vel a, a) = 0. An
    /// acceleration finds a with w.pos = w.vel = 0. History::accept() maps (q, v) to (q,
    /// v). MovingHistory::carry() maps (q, v, a) to (q, v, a).
    enum class Kind { stage, acceleration, accept, carry } kind;  // kind of operation
    std::array<Combination, 3> of;                                // q, v and a
    Weights w;          // weights of a in q and v
    std::size_t first;  // of its results
  };

  std::size_t inputs = 0;             // number of inputs
  std::size_t vectors = 0;            // number of inputs and of results of operations
  std::vector<Operation> operations;  // operations in their order
  std::vector<Combination> results;   // the vectors of state()

  /// Returns whether both are the same program with the same factors.
  bool operator==(const StepTable& other) const;
};

/// Finds the StepTable of a method by running the method itself, so that no method has to
/// write down its transpose. The method moves a system whose coordinate k is the factor
/// of the step's vector k. Inputs are unit vectors, and every operation is prescribed to
/// return the next unit vectors.
class StepProbe final : public System,
                        public StageWatcher,
                        private ExplicitForm,
                        private MovingHistory {
 public:
  /// Takes the `options` of the run, by a method without no_transposed_steps().
  StepProbe(std::string_view method, const Options& options);

  /// Starts the method at time t.
  StepTable start(double t);
  /// Steps to t as the run did that `run` has recorded.
  StepTable step(double t, const WatchedSystem& run);
  /// Goes to time t, with the single numbers of a state of the method.
  void go_to(double t, In numbers);

  Layout layout() const override { return {most_vectors, 0}; }
  Traits traits() const override { return {}; }
  void initial_state(Out q, Out v) const override;
  void scale(Out q_typ, Out v_typ) const override;
  Status residual(double t, In q, In v, In a, Out r) noexcept override;
  Status linearize(double t, In q, In v, In a, Weights w) noexcept override;
  Status solve(In b, Out x) noexcept override;
  ExplicitForm* explicit_form() override { return this; }
  History* history() override { return this; }

  void solved(double t, In q, In v, In a, In lambda) noexcept override;

 private:
  /// A state of up to 4 vectors, 5 stages, a renewal (2 vectors), two motions carried
  /// (3 each) and an acceleration: 18.
  static constexpr int most_vectors = 24;
  using Kind = StepTable::Operation::Kind;

  Status acceleration(double t, In q, In v, Out a) noexcept override;
  bool accept(double t, InOut q, InOut v) override;
  bool carry(double t, InOut q, InOut v, InOut a) const override;
  std::string not_smooth() const override { return {}; }
  void reset() override {}
  std::vector<double> memory() const override { return {}; }
  void recall(In /*memory*/) override {}

  void begin(std::size_t inputs);
  void note(Kind kind, std::array<In, 3> of, Weights w) const;
  void give(InOut x) const;
  StepTable taken();

  std::unique_ptr<Integrator> method_;
  FixedStep& fixed_;
  // Of the step in progress. MovingHistory::carry() is const.
  mutable StepTable table_;
  mutable std::size_t next_ = 0, to_carry_ = 0;
  bool moves_ = false;
};

}  // namespace tress::integrators
