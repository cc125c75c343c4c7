#pragma once

#include <string_view>
#include <vector>

#include "integrators/block/block_error.h"
#include "integrators/block/block_solver.h"
#include "integrators/block/step_limits.h"

namespace tress::integrators {

/// Steps strands with step lengths that each strand's own estimated error allows. A step
/// is a power-of-two part of an interval and starts at a multiple of itself. Strands at
/// the same time with the same step share one step in parallel lanes, with the same poses
/// of the head. The interval is halved until it is no longer than a strand's next step;
/// the first half comes first. Strands are independent: results are bit-identical for any
/// number of lanes and any set of strands stepped together. Memory of one thread.
///
/// A step with too large an error, or one on which Newton's whole corrections fail, is
/// repeated as two or more shorter ones. The shortest step (StepLimits) without a
/// solution is taken in parts (BlockSolver), without an estimate, or the strand fails.
template <class N>
class ControlledBlocks {
 public:
  /// The others must outlive it; `least`: no shorter steps, s.
  ControlledBlocks(const Block<N>& block, const BlockMethod& method, double tolerance,
                   double least, BlockSolver<N>& solver);

  /// Strand that failed.
  struct Loss {
    std::size_t strand;       // index of the strand
    double at;                // the start of its step, as a part of the interval
    std::string_view reason;  // cause, for messages
  };

  /// An interval of strands first to last - 1 that are not lost. Returns those that are
  /// from now on.
  const std::vector<Loss>& step(std::size_t first, std::size_t last,
                                BlockStore<N>& strands, const TimeSpan& span,
                                NewtonWork& done);

 private:
  using Step = typename BlockSolver<N>::Step;
  class Judge;

  std::vector<std::size_t>& later_of(int level);
  void go(const Step& interval, double begin, int level);
  bool fits(BlockStore<N>& strands, std::size_t strand, double h) const;
  bool can_halve(const BlockStore<N>& strands, std::size_t strand, double h) const;
  double typical_time(const BlockStore<N>& strands, std::size_t strand) const;
  void take(const Step& interval, double begin, double part,
            std::vector<std::size_t>& later);
  void renew();
  /// Returns the index of the strands of `work` that hold the results of a step.
  std::size_t stepped() const;

  const BlockEstimate& estimate_;
  std::size_t first_stage_;
  double stage_end_, threshold_;
  StepLimits limits_;
  double least_;
  BlockSolver<N>& solver_;
  BlockError<N> error_;
  std::vector<std::vector<std::size_t>> later_;  // strands, by levels
  std::vector<std::size_t> now_, stuck_;
  std::vector<Loss> lost_;
};

extern template class ControlledBlocks<double>;
extern template class ControlledBlocks<float>;

}  // namespace tress::integrators
