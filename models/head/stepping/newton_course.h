#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "models/head/stepping/lane_work.h"

/// How Newton's iterations of strands side by side go on and end: each lane by the sizes
/// of its own corrections, so that no strand depends on its neighbours. A Course has
///
///     start(lane, work)                // of a strand that has come into this lane
///     go_on(work, size) -> verdicts    // after a correction of all lanes: moves a
///
/// and, if it does more than one kernel call for each correction, counts those. `whole`:
/// whether it goes on by whole corrections (LaneWork::newton).
namespace tress::models {

enum class NewtonVerdict { go_on, converged, failed };

/// The limits of integrators/stage.h.
struct NewtonRules {
  double tolerance;  // of a correction
  double left;       // of the error, by the rate at which corrections shrink
  double rounding;   // below it corrections that stop shrinking are rounding errors
  int iterations;

  /// Of a tolerance that has no margin of its own: what is left is a tenth of it.
  static constexpr double margin = 0.1;

  /// Numbers resolve corrections of a size `resolved` only.
  static NewtonRules of(double tolerance, double left, int iterations, double resolved) {
    const double seen = std::max(tolerance, resolved / 2);
    return {seen, left * seen,
            std::max({tolerance, std::min(1e4 * tolerance, 1e-6), 4 * resolved}),
            iterations};
  }
};

/// One whole correction, as Stage::single_step().
template <class Model>
class SingleCourse {
 public:
  using T = typename Model::Real;
  using Verdicts = std::array<NewtonVerdict, static_cast<std::size_t>(T::lanes)>;
  static constexpr bool whole = false;  // there is none before

  void start(int /*lane*/, const LaneWork<Model>& /*work*/) {}
  Verdicts go_on(LaneWork<Model>& work, const T& size) {
    work.move(T(1), work.step.data());
    Verdicts all;
    for (std::size_t k = 0; k < all.size(); ++k) {
      all[k] = std::isfinite(lane_of(size, static_cast<int>(k)))
                   ? NewtonVerdict::converged
                   : NewtonVerdict::failed;
    }
    return all;
  }
};

/// Whole corrections, as Stage::newton().
template <class Model>
class PlainCourse {
 public:
  using T = typename Model::Real;
  using Verdicts = std::array<NewtonVerdict, static_cast<std::size_t>(T::lanes)>;
  static constexpr bool whole = true;

  /// `left`: the part of the tolerance that may be left.
  PlainCourse(const Model& model, double tolerance, double left, int iterations)
      : model_(model), tolerance_(tolerance), left_(left), iterations_(iterations) {}

  void start(int lane, const LaneWork<Model>& work) {
    of_lane_[static_cast<std::size_t>(lane)] = {
        NewtonRules::of(tolerance_, left_, iterations_, work.resolved(model_, lane))};
  }
  Verdicts go_on(LaneWork<Model>& work, const T& size) {
    work.move(T(1), work.step.data());
    Verdicts all;
    for (std::size_t k = 0; k < all.size(); ++k) {
      all[k] = of_lane_[k].judge(lane_of(size, static_cast<int>(k)));
    }
    return all;
  }

 private:
  static constexpr int most_grown = 2;

  struct OfLane {
    NewtonRules rules{};
    int done = 0, grown = 0;
    double previous = std::numeric_limits<double>::infinity();

    NewtonVerdict judge(double size) {
      if (!std::isfinite(size)) return NewtonVerdict::failed;
      const double rate = size / previous;
      // Of the error that is left the rate tells; the first correction has none yet.
      const double left = done > 0 && rate < 1 ? size * rate / (1 - rate) : size;
      if (size <= rules.tolerance || left <= rules.left ||
          (rate > 0.5 && done >= 2 && size <= rules.rounding)) {
        return NewtonVerdict::converged;
      }
      if (rate > 1 && done > 0 && ++grown == most_grown) return NewtonVerdict::failed;
      previous = size;
      return ++done == rules.iterations ? NewtonVerdict::failed : NewtonVerdict::go_on;
    }
  };

  const Model& model_;
  double tolerance_, left_;
  int iterations_;
  std::array<OfLane, static_cast<std::size_t>(T::lanes)> of_lane_{};
};

/// Damped corrections: the whole one, or the largest halving of it after which the next
/// one with the same matrix is smaller [Deuflhard 2011, section 3.3], as Stage::damped().
/// Lanes wait for the one that halves most.
template <class Model>
class DampedCourse {
 public:
  using T = typename Model::Real;
  static constexpr auto width = static_cast<std::size_t>(T::lanes);
  using Verdicts = std::array<NewtonVerdict, width>;
  static constexpr bool whole = false;

  DampedCourse(const Model& model, double tolerance, int most_iterations)
      : model_(model),
        tolerance_(tolerance),
        iterations_(most_iterations),
        from_(model.unknowns()),
        step_(from_) {}

  void start(int lane, const LaneWork<Model>& work) {
    of_lane_[static_cast<std::size_t>(lane)] = {
        .rules = NewtonRules::of(tolerance_, NewtonRules::margin, patience * iterations_,
                                 work.resolved(model_, lane)),
        .runs = true};
  }
  Verdicts go_on(LaneWork<Model>& work, const T& size) {
    std::copy_n(work.a(), from_.size(), from_.begin());
    step_.swap(work.step);
    T part(1);
    Verdicts all;
    bool waits[width];
    for (std::size_t k = 0; k < width; ++k) {
      all[k] = of_lane_[k].judge(lane_of(size, static_cast<int>(k)));
      waits[k] = of_lane_[k].runs && all[k] == NewtonVerdict::go_on;
    }
    for (;;) {
      std::copy(from_.begin(), from_.end(), work.a());
      work.move(part, step_.data());
      const auto waiting = std::count(waits, waits + width, true);
      if (waiting == 0) break;
      iterations += waiting;
      lanes += T::lanes;
      const T next = work.again(model_);
      for (std::size_t k = 0; k < width; ++k) {
        if (!waits[k]) continue;
        const auto lane = static_cast<int>(k);
        const double taken = lane_of(part, lane), before = lane_of(size, lane);
        waits[k] = !(lane_of(next, lane) <= (1 - taken / 4) * before);
        if (!waits[k]) continue;
        set_lane(part, lane, taken / 2);
        if (taken / 2 >= shortest) continue;
        waits[k] = false;
        all[k] = before <= of_lane_[k].rules.rounding ? NewtonVerdict::converged
                                                      : NewtonVerdict::failed;
      }
    }
    for (std::size_t k = 0; k < width; ++k) {
      of_lane_[k].runs = of_lane_[k].runs && all[k] == NewtonVerdict::go_on;
    }
    return all;
  }

  long iterations = 0, lanes = 0;  // with kept matrices

 private:
  static constexpr int patience = 3;  // damped corrections are smaller: more of them
  static constexpr double shortest = 1e-4;

  struct OfLane {
    NewtonRules rules{};
    int done = 0;
    bool runs = false;

    NewtonVerdict judge(double size) {
      if (size <= rules.tolerance) return NewtonVerdict::converged;
      return std::isfinite(size) && ++done < rules.iterations ? NewtonVerdict::go_on
                                                              : NewtonVerdict::failed;
    }
  };

  const Model& model_;
  double tolerance_;
  int iterations_;
  std::vector<T> from_, step_;
  std::array<OfLane, width> of_lane_{};
};

}  // namespace tress::models
