#pragma once

#include <string_view>
#include <vector>

#include "contract/newton_work.h"
#include "integrators/block/block_store.h"
#include "integrators/block/newton_course.h"
#include "integrators/block/time_span.h"

namespace tress::integrators {

/// Limits of Newton's iteration: see Options.
struct NewtonLimits {
  double tolerance;  // bound of the last correction, as in Options::newton_tolerance
  double left;       // see PlainCourse
  int iterations;    // bound of the corrections, as in Options::newton_iterations
};

/// Receiver of the outcome of each strand's step.
class StepJudge {
 public:
  virtual ~StepJudge() = default;
  virtual void ended() = 0;  // BlockWork::end() has been called
  virtual void judged(int lane, std::size_t strand) = 0;  // that of a lane
  /// Called for a strand whose step has no solution, at the stage where that was found.
  virtual void failed(std::size_t strand, std::size_t stage) = 0;
};

/// Steps strands by the stages of a BlockMethod, stage by stage. Newton's iteration comes
/// first. Strands on which it fails get damped iterations, as in Stage: from the guess,
/// from zero acceleration and from standstill. Strands on which these fail take 2, 4, ...
/// shorter steps. All strands are processed in parallel lanes; a finished lane takes the
/// next strand. Decisions are made per lane, so results are bit-identical for any number
/// of lanes and any set of strands stepped together. Memory of one thread.
template <class N>
class BlockSolver {
 public:
  /// `block` and `method` must outlive it.
  BlockSolver(Block<N>& block, const BlockMethod& method, const NewtonLimits& newton);

  BlockWork<N> work;  // Equations of the strands in lanes, and their state.

  /// Strand that failed.
  struct Loss {
    std::size_t strand;       // index of the strand
    std::string_view reason;  // cause, for messages
  };
  /// Data of a call of step().
  struct Step {
    BlockStore<N>& strands;  // strands that are stepped
    TimeSpan span;           // interval of time
    NewtonWork& done;        // work done, to which the call adds
  };

  /// A step of the queue's strands that are not lost. Returns those that are from now on.
  const std::vector<Loss>& step(LaneQueue all, const Step& now);
  /// Steps strands with whole corrections only: strands on which they fail at a stage are
  /// reported as failed. `judge` judges the others at the end of their step.
  const std::vector<Loss>& attempt(const Step& now, const LaneQueue& all,
                                   StepJudge& judge);
  /// Repeats the step of these strands, on which it has failed, as `parts` shorter steps,
  /// then twice that number, up to 64. Leaves in `strands` those that remain unsolved.
  void in_parts(const Step& now, std::vector<std::size_t>& strands, int parts);
  /// A step of a linear() method, of blocks first to last - 1 where they lie.
  const std::vector<Loss>& correct_blocks(std::size_t first, std::size_t last,
                                          const Step& now);

  /// Length of a step in the block's units.
  double length(const TimeSpan& of) const { return of.length(1) / work_time_; }

  /// Reason of a Loss: even the shortest steps have no solution.
  static constexpr std::string_view no_solution =
      "no solution for the step, nor for 64 parts of it";

 private:
  static constexpr int most_parts = 64;
  static constexpr std::string_view not_finite = "the result of the step is not finite";

  /// A stage of the strands of a queue.
  struct Run {
    const Step& now;
    LaneQueue queue;
    std::size_t stage;
    NewtonCourse<N>& course;
    long& iterations;
    long& lanes;
    NewtonStart from = NewtonStart::guess;
  };

  void begin(const Step& now, const LaneQueue& all);
  void set_step(const TimeSpan& span);
  void find_fresh(LaneQueue all, const BlockStore<N>& strands);
  void start(const Step& now);
  void correct_once(const Step& now, const LaneQueue& queue, std::string_view reason);
  void iterate(const Step& now, const LaneQueue& all);
  void damp(const Step& now, std::size_t stage);
  void take_part(const Step& whole, int i, int parts);
  void renew(const Step& now);
  PlainCourse<N> plain() const;
  /// Strands on which the course fails are in failed_ then; those that are solved go
  /// home.
  void run(const Run& of);
  void run(Run of, StepJudge& judge);
  void correct_block(std::size_t block, const Step& now, double h);
  void lose(const Step& now, std::size_t strand, std::string_view reason);

  Block<N>& block_;
  const BlockMethod& method_;
  NewtonLimits newton_;
  double work_time_;
  std::vector<std::size_t> fresh_, others_;    // in first steps, and beyond them
  std::vector<std::size_t> failed_, waiting_;  // at a stage; to be tried again
  std::vector<std::size_t> stuck_, unsolved_;  // at some stage, sorted; in the end
  BlockStore<N> some_;                         // that take a step in parts
  std::vector<std::size_t> home_, before_;     // strands in lanes
  std::vector<NewtonVerdict> verdicts_;
  std::vector<Loss> lost_;
};

extern template class BlockSolver<double>;
extern template class BlockSolver<float>;

}  // namespace tress::integrators
