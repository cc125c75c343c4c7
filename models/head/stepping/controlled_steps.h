#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <vector>

#include "models/head/stepping/lane_error.h"
#include "models/head/stepping/lane_solver.h"
#include "models/head/stepping/step_limits.h"

namespace tress::models {

/// Steps of strands that are as long as each one's own estimated error allows, by
/// HeadOptions::tolerance: powers of two parts of an interval that start at multiples of
/// themselves. So strands that are at the same time and take the same step are lanes of
/// one step, with the same poses of the head; the interval is halved until it is no
/// longer than what a strand asks for, first half first. What a strand does depends on
/// itself alone: results are the same bits for any number of lanes and whatever strands
/// are stepped together. Memory of one thread.
///
/// A step with too large an error, or one on which whole corrections of Newton's fail, is
/// taken again as two or more shorter ones. The shortest (StepLimits) without a solution
/// is taken in parts (LaneSolver), without an estimate, or the strand is lost.
template <class Model>
class ControlledSteps {
 public:
  using T = typename Model::Real;
  using Solver = LaneSolver<Model>;
  using PoseAt = typename Solver::PoseAt;
  using Meet = typename Solver::Meet;

  /// The others must outlive it; `least`: no shorter steps, without units.
  ControlledSteps(const Model& model, const LaneMethod& method, double tolerance,
                  double least, Solver& solver)
      : model_(model),
        estimate_(*method.estimate),
        first_stage_(method.first()),
        stage_end_(method.stages[first_stage_].time),
        threshold_(estimate_.threshold(tolerance)),
        limits_(StepLimits::of(method, tolerance,
                               std::numeric_limits<typename T::Scalar>::epsilon())),
        least_(least),
        solver_(solver),
        error_(model) {}

  struct Loss {
    std::size_t strand;
    double at;  // the start of its step, as a part of the interval
    std::string_view reason;
  };

  /// An interval of h of strands first to last - 1 that are not lost; without units, as
  /// poses. Returns those that are from now on.
  const std::vector<Loss>& step(std::size_t first, std::size_t last,
                                LaneStrands<Model>& strands, const PoseAt& pose,
                                const Meet& meet, double h, HeadWork& done) {
    lost_.clear();
    const Interval interval{strands, pose, meet, h, done};
    std::vector<std::size_t>& all = later_of(0);
    all.clear();
    for (std::size_t k = first; k < last; ++k) {
      if (strands.lost(k)) continue;
      all.push_back(k);
      StepLength& length = strands.length(k);
      if (!length.begun()) length.begin(limits_.first * typical_time(strands, k));
    }
    go(interval, 0, 0);
    return lost_;
  }

 private:
  struct Interval {
    LaneStrands<Model>& strands;
    const PoseAt& pose;
    const Meet& meet;
    double h;
    HeadWork& done;
  };

  /// A step is kept if its error is small.
  struct Judge {
    ControlledSteps& of;
    const typename Solver::Step& now;
    std::vector<std::size_t>& later;
    double begin;
    T error{};

    void ended(const StepPoses& poses) {
      error = of.error_.of(of.model_, of.solver_.work, poses.to);
      of.renew(poses.to);
    }
    void judged(int lane, std::size_t strand) {
      LaneWork<Model>& work = of.solver_.work;
      StepLength& length = now.strands.length(strand);
      const double over = lane_of(error, lane) / of.threshold_;
      if (over <= 1) {
        length.accept(now.h, over, of.estimate_.falls);
        // The step began with the acceleration before its last.
        T& before = work.after[4 * work.size() + 1];
        if (lane_of(work.after[4 * work.size()], lane) > 0) set_lane(before, lane, now.h);
        now.strands.put_home(of.elements_of(work).data(), work.after.data(), lane,
                             strand);
        ++now.done.steps;
        return;
      }
      ++now.done.rejected_by_error;
      length.reject(now.h, over, of.estimate_.falls);
      now.strands.interrupt(strand, now.h, of.stage_end_);
      if (of.can_halve(now.strands, strand, now.h)) {
        later.push_back(strand);
      } else {
        now.strands.lose(strand);
        of.lost_.push_back({strand, begin, "the tolerance needs too short a step"});
      }
    }
    void failed(std::size_t strand, std::size_t stage) {
      ++now.done.rejected_by_newton;
      now.strands.length(strand).unsolved(now.h);
      if (stage > of.first_stage_) now.strands.interrupt(strand, now.h, of.stage_end_);
      (of.can_halve(now.strands, strand, now.h) ? later : of.stuck_).push_back(strand);
    }
  };

  std::vector<std::size_t>& later_of(int level) {
    while (later_.size() <= static_cast<std::size_t>(level)) later_.emplace_back();
    return later_[static_cast<std::size_t>(level)];
  }

  /// What later_of(level) has, from `begin` on over 2^-level of the interval.
  void go(const Interval& interval, double begin, int level) {
    const double part = std::ldexp(1.0, -level), h = part * interval.h;
    now_.clear();
    std::vector<std::size_t>& later = later_of(level + 1);
    later.clear();
    for (const std::size_t strand : later_of(level)) {
      if (!interval.strands.lost(strand)) {
        (fits(interval.strands, strand, h) ? now_ : later).push_back(strand);
      }
    }
    if (!now_.empty()) take(interval, begin, part, later);
    if (later.empty()) return;
    go(interval, begin, level + 1);
    go(interval, begin + part / 2, level + 1);
  }

  /// Whether it takes a step of h.
  bool fits(LaneStrands<Model>& strands, std::size_t strand, double h) const {
    return strands.length(strand).next() >= h || !can_halve(strands, strand, h);
  }
  bool can_halve(const LaneStrands<Model>& strands, std::size_t strand, double h) const {
    return h / 2 >= std::max(least_, limits_.shortest * typical_time(strands, strand));
  }
  /// In which it falls by its length.
  double typical_time(const LaneStrands<Model>& strands, std::size_t strand) const {
    constexpr auto width = static_cast<std::size_t>(T::lanes);
    return std::sqrt(
        lane_of(LaneError<Model>::length(model_, strands.strand(strand / width)),
                static_cast<int>(strand % width)));
  }

  /// The step of those in now_; those that need shorter ones go to `later`.
  void take(const Interval& interval, double begin, double part,
            std::vector<std::size_t>& later) {
    const PoseAt pose = [&](double x) { return interval.pose(begin + x * part); };
    const Meet meet = [&](double x, double share) {
      interval.meet(begin + x * part, share * part);
    };
    const typename Solver::Step now{interval.strands, pose, meet, part * interval.h,
                                    interval.done};
    stuck_.clear();
    Judge judge{*this, now, later, begin};
    for (const auto& [strand, reason] :
         solver_.attempt(now, {0, now_.size(), &now_}, judge)) {
      lost_.push_back({strand, begin, reason});
    }
    interval.done.steps += static_cast<long>(stuck_.size());
    solver_.in_parts(now, stuck_, 1);
    interval.done.steps -= static_cast<long>(stuck_.size());
    for (const std::size_t strand : stuck_) {
      lost_.push_back({strand, begin, Solver::no_solution});
    }
    std::ranges::sort(later);
  }

  /// Reference frames at the end of a step, for the next one: strands with new ones have
  /// no steps behind them. They are those of lanes that are judged; others go on in
  /// theirs.
  void renew(const RootPose& to) {
    if constexpr (Model::Element::kept > 0) {
      LaneWork<Model>& work = solver_.work;
      elements_ = work.elements;
      T* const q = work.after.data();
      const T renewed = model_.renew(elements_.data(), model_.clamp(work.strand, to), q,
                                     q + work.size());
      for (std::size_t k = 4 * work.size(); k < work.after.size(); ++k) {
        work.after[k] = where_less(T(0), renewed, T(0), work.after[k]);
      }
    }
  }
  std::vector<typename Model::Element>& elements_of(LaneWork<Model>& work) {
    if constexpr (Model::Element::kept > 0) return elements_;
    return work.elements;
  }

  const Model& model_;
  const LaneEstimate& estimate_;
  std::size_t first_stage_;
  double stage_end_, threshold_;
  StepLimits limits_;
  double least_;
  Solver& solver_;
  LaneError<Model> error_;
  std::vector<typename Model::Element> elements_;  // renewed ones
  std::vector<std::vector<std::size_t>> later_;    // strands, by levels
  std::vector<std::size_t> now_, stuck_;
  std::vector<Loss> lost_;
};

}  // namespace tress::models
