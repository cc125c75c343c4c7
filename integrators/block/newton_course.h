#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "integrators/block/block_work.h"
#include "integrators/stage/newton_rules.h"

namespace tress::integrators {

/// Decision for a lane after a correction: `go_on`, `converged` or `failed`.
enum class NewtonVerdict { go_on, converged, failed };

/// Control of Newton's iterations of strands in lanes. Each lane is judged by the sizes
/// of its own corrections, so that no strand depends on its neighbours.
template <class N>
class NewtonCourse {
 public:
  /// Decisions for all lanes: in, those that iterate; out, what comes next.
  using Verdicts = std::span<NewtonVerdict>;

  virtual ~NewtonCourse() = default;
  /// Whether it goes on by whole corrections (BlockWork::newton).
  virtual bool whole() const = 0;
  /// Starts the iteration of a strand that has entered this lane.
  virtual void start(int lane, const BlockWork<N>& work) = 0;
  /// After a correction of all lanes: moves a.
  virtual void go_on(BlockWork<N>& work, Verdicts all) = 0;
};

/// One whole correction, as Newton::single_step().
template <class N>
class SingleCourse final : public NewtonCourse<N> {
 public:
  bool whole() const override { return false; }  // there is none before
  void start(int /*lane*/, const BlockWork<N>& /*work*/) override {}
  /// Takes one correction in each lane that iterates, and ends it.
  void go_on(BlockWork<N>& work, std::span<NewtonVerdict> all) override;
};

/// Whole corrections, as Newton.
template <class N>
class PlainCourse final : public NewtonCourse<N> {
 public:
  /// `left`: the part of the tolerance that may be left.
  PlainCourse(double tolerance, double left, int iterations)
      : tolerance_(tolerance), left_(left), iterations_(iterations) {}

  bool whole() const override { return true; }
  void start(int lane, const BlockWork<N>& work) override;
  /// Judges the last corrections and takes the next ones.
  void go_on(BlockWork<N>& work, std::span<NewtonVerdict> all) override;

 private:
  struct OfLane {
    NewtonRules rules{};
    int done = 0, grown = 0;
    double previous = std::numeric_limits<double>::infinity();

    NewtonVerdict judge(double size, int iterations);
  };

  double tolerance_, left_;
  int iterations_;
  std::array<OfLane, 32> of_lane_{};
};

/// Damped corrections: the whole one, or the largest halving of it after which the next
/// one with the same matrix is smaller [Deuflhard 2011, section 3.3], as Damped.
/// Lanes wait for the one that halves most.
template <class N>
class DampedCourse final : public NewtonCourse<N> {
 public:
  /// Takes at most damped_patience times `most_iterations` corrections.
  DampedCourse(double tolerance, int most_iterations)
      : tolerance_(tolerance), iterations_(damped_patience * most_iterations) {}

  bool whole() const override { return false; }
  void start(int lane, const BlockWork<N>& work) override;
  /// Judges the last corrections and takes the next ones, damped.
  void go_on(BlockWork<N>& work, std::span<NewtonVerdict> all) override;

  long iterations = 0, lanes = 0;  // with kept matrices

 private:
  struct OfLane {
    NewtonRules rules{};
    int done = 0;
    bool runs = false;

    NewtonVerdict judge(double size, int most_iterations);
  };

  double tolerance_;
  int iterations_;
  LaneVector<N> from_, step_;
  std::vector<N> sizes_, part_;
  std::array<OfLane, 32> of_lane_{};
};

extern template class SingleCourse<double>;
extern template class SingleCourse<float>;
extern template class PlainCourse<double>;
extern template class PlainCourse<float>;
extern template class DampedCourse<double>;
extern template class DampedCourse<float>;

}  // namespace tress::integrators
