#pragma once

#include <algorithm>
#include <functional>
#include <string_view>
#include <vector>

#include "models/head/head.h"
#include "models/head/stepping/lane_strands.h"
#include "models/head/stepping/newton_course.h"

namespace tress::models {

/// Steps of strands by the stages of a LaneMethod, stage by stage: Newton's iteration,
/// damped iterations of the strands on which it fails, as integrators/stage.h's, from the
/// guess, from zero acceleration and from standstill, and 2, 4, ... shorter steps of
/// those on which they fail. All go side by side, and lanes that are done take the next
/// strand. Decisions are taken lane by lane, so results are the same bits for any number
/// of lanes and whatever strands are stepped together. Memory of one thread.
template <class Model>
class LaneSolver {
 public:
  using T = typename Model::Real;
  using PoseAt = std::function<RootPose(double part)>;  // of the step, 0 to 1
  /// Finds loads of bodies there, of a stage of gamma h = `share` of the step, from
  /// `work` as it is.
  using Meet = std::function<void(double part, double share)>;

  /// `model` and `method` must outlive it. `left`: see PlainCourse.
  LaneSolver(const Model& model, const LaneMethod& method, double tolerance, double left,
             int most_iterations)
      : work(model, method),
        model_(model),
        method_(method),
        tolerance_(tolerance),
        left_(left),
        iterations_(most_iterations),
        some_(model, method, false) {}

  LaneWork<Model> work;

  struct Loss {
    std::size_t strand;
    std::string_view reason;
  };
  struct Step {
    LaneStrands<Model>& strands;
    const PoseAt& pose;
    const Meet& meet;
    double h;
    HeadWork& done;
  };

  /// A step of h of the queue's strands that are not lost; without units, as poses.
  /// Returns those that are from now on.
  const std::vector<Loss>& step(LaneQueue all, LaneStrands<Model>& strands,
                                const PoseAt& pose, const Meet& meet, double h,
                                HeadWork& done) {
    const Step now{strands, pose, meet, h, done};
    begin(now, all);
    const LaneQueue fresh{0, fresh_.size(), &fresh_}, others{0, others_.size(), &others_};
    if (method_.iterates) {
      if (!fresh_.empty()) start(now);
      iterate(now, all);
    } else {
      if (!fresh_.empty()) iterate(now, fresh);
      correct_once(now, fresh_.empty() ? all : others,
                   "the result of the step is not finite");
    }
    return lost_;
  }

  /// The same by whole corrections alone: strands on which they fail at a stage are
  /// failed(strand, stage). At its end the step of the others is judged:
  ///
  ///     ended(poses)           // work.end() has been called
  ///     judged(lane, strand)   // that of a lane
  template <class Judge>
  const std::vector<Loss>& attempt(const Step& now, const LaneQueue& all, Judge& judge) {
    begin(now, all);
    if (!fresh_.empty()) start(now);
    for (std::size_t k = method_.first(); k < method_.stages.size(); ++k) {
      failed_.clear();
      PlainCourse<Model> plain(model_, tolerance_, left_, iterations_);
      if (k + 1 < method_.stages.size()) {
        run(now, all, k, plain, failed_, now.done.iterations, now.done.lanes);
      } else {
        run(now, all, k, plain, failed_, now.done.iterations, now.done.lanes, judge);
      }
      for (const std::size_t strand : failed_) judge.failed(strand, k);
      stuck_.insert(stuck_.end(), failed_.begin(), failed_.end());
      std::ranges::sort(stuck_);
    }
    return lost_;
  }

  /// The step of these strands, on which it has failed: `parts`, twice as many and so on
  /// shorter ones, to 64. Leaves those that are lost.
  void in_parts(const Step& now, std::vector<std::size_t>& strands, int parts) {
    stuck_.clear();  // strands have other numbers among some_
    const StepPoses whole = poses_;
    for (; parts <= most_parts && !strands.empty(); parts *= 2) {
      some_.clear();
      for (const std::size_t strand : strands) some_.add(now.strands, strand);
      for (int i = 0; i < parts; ++i) take_part(now, i, parts);
      std::size_t left = 0;
      for (std::size_t k = 0; k < strands.size(); ++k) {
        if (some_.lost(k)) {
          strands[left++] = strands[k];
        } else {
          now.strands.take(strands[k], some_, k);
          now.done.shortened += parts > 1 ? 1 : 0;
        }
      }
      strands.resize(left);
    }
    poses_ = whole;
    for (const std::size_t strand : strands) now.strands.lose(strand);
  }

  static constexpr std::string_view no_solution =
      "no solution for the step, nor for 64 parts of it";

 private:
  static constexpr int most_parts = 64;

  /// Strands that are solved go home.
  struct Home {
    LaneStrands<Model>& strands;
    LaneWork<Model>& work;

    void ended(const StepPoses& /*poses*/) {}
    void judged(int lane, std::size_t strand) {
      strands.put_home(work.elements.data(), work.after.data(), lane, strand);
    }
  };

  void begin(const Step& now, const LaneQueue& all) {
    lost_.clear();
    stuck_.clear();
    poses_.from = now.pose(0);
    poses_.to = now.pose(1);
    find_fresh(all, now.strands);
  }

  /// Which of these strands take first steps.
  void find_fresh(LaneQueue all, const LaneStrands<Model>& strands) {
    fresh_.clear();
    others_.clear();
    if (method_.first_steps == 0) return;
    for (; all.next < all.end; ++all.next) {
      (strands.fresh(all.strand()) ? fresh_ : others_).push_back(all.strand());
    }
  }

  /// Those of the fresh ones that have no acceleration are lost.
  void start(const Step& now) {
    correct_once(now, {0, fresh_.size(), &fresh_}, "no acceleration at the start");
  }

  /// One correction of the first stage, or the strand is lost.
  void correct_once(const Step& now, const LaneQueue& queue, std::string_view reason) {
    failed_.clear();
    SingleCourse<Model> single;
    run(now, queue, 0, single, failed_, now.done.iterations, now.done.lanes);
    for (const std::size_t strand : failed_) lose(now, strand, reason);
  }

  void iterate(const Step& now, const LaneQueue& all) {
    HeadWork& done = now.done;
    for (std::size_t k = method_.first(); k < method_.stages.size(); ++k) {
      PlainCourse<Model> plain(model_, tolerance_, left_, iterations_);
      failed_.clear();
      run(now, all, k, plain, failed_, done.iterations, done.lanes);
      done.retried += static_cast<long>(failed_.size());
      damp(now, k);
      stuck_.insert(stuck_.end(), failed_.begin(), failed_.end());
      std::ranges::sort(stuck_);
    }
    unsolved_.swap(stuck_);
    in_parts(now, unsolved_, 2);
    for (const std::size_t strand : unsolved_) lost_.push_back({strand, no_solution});
  }

  /// A stage of those in failed_, where those remain on which this fails, too: damped
  /// corrections from everywhere.
  void damp(const Step& now, std::size_t stage) {
    for (const NewtonStart from :
         {NewtonStart::guess, NewtonStart::zero, NewtonStart::standstill}) {
      if (failed_.empty()) return;
      waiting_.swap(failed_);
      failed_.clear();
      std::ranges::sort(waiting_);
      DampedCourse<Model> damped(model_, tolerance_, iterations_);
      run(now, {0, waiting_.size(), &waiting_}, stage, damped, failed_,
          now.done.again_iterations, now.done.again_lanes, from);
      now.done.again_iterations += damped.iterations;
      now.done.again_lanes += damped.lanes;
    }
  }

  /// Of some_: those on which it fails are lost there.
  void take_part(const Step& whole, int i, int parts) {
    const PoseAt pose = [&](double part) { return whole.pose((i + part) / parts); };
    const Meet meet = [&](double part, double share) {
      whole.meet((i + part) / parts, share / parts);
    };
    HeadWork done;
    const Step now{some_, pose, meet, whole.h / parts, done};
    poses_.from = pose(0);
    poses_.to = pose(1);
    if (i > 0) renew(now);
    for (std::size_t k = method_.first(); k < method_.stages.size(); ++k) {
      PlainCourse<Model> plain(model_, tolerance_, left_, iterations_);
      failed_.clear();
      run(now, {0, some_.size()}, k, plain, failed_, done.again_iterations,
          done.again_lanes);
      damp(now, k);
      for (const std::size_t strand : failed_) some_.lose(strand);
    }
    done.in_parts = done.again_iterations;
    whole.done += done;
  }
  /// Strands with new reference frames have no steps behind them, and the first stage to
  /// solve if there is one.
  void renew(const Step& now) {
    waiting_.clear();
    for (std::size_t block = 0; block < some_.blocks(); ++block) {
      const T renewed = some_.renew(model_, block, poses_.from);
      for (std::size_t k = 0; k < some_.of(block); ++k) {
        if (lane_of(renewed, static_cast<int>(k)) > 0) {
          waiting_.push_back(T::lanes * block + k);
        }
      }
    }
    if (waiting_.empty() || method_.first() == 0) return;
    SingleCourse<Model> single;
    failed_.clear();
    run(now, {0, waiting_.size(), &waiting_}, 0, single, failed_,
        now.done.again_iterations, now.done.again_lanes);
    for (const std::size_t strand : failed_) some_.lose(strand);
  }

  template <class Course>
  void run(const Step& now, const LaneQueue& queue, std::size_t stage, Course& course,
           std::vector<std::size_t>& failed, long& iterations, long& lanes,
           NewtonStart from = NewtonStart::guess) {
    Home home{now.strands, work};
    run(now, queue, stage, course, failed, iterations, lanes, home, from);
  }
  /// A stage. Strands on which the course fails go to `failed`.
  template <class Course, class Judge>
  void run(const Step& now, LaneQueue queue, std::size_t stage, Course& course,
           std::vector<std::size_t>& failed, long& iterations, long& lanes, Judge& judge,
           NewtonStart from = NewtonStart::guess) {
    const LaneStage& of = method_.stages[stage];
    poses_.at = now.pose(of.time);
    constexpr std::size_t none = LaneStrands<Model>::none;
    typename LaneStrands<Model>::Lanes home;
    home.fill(none);
    for (bool refill = true;;) {
      if (refill) {
        const auto before = home;
        now.strands.fill(home, queue, stuck_, work);
        if (std::ranges::all_of(home, [](std::size_t k) { return k == none; })) break;
        T starts(0);
        for (std::size_t k = 0; k < home.size(); ++k) {
          if (before[k] == none) starts.set(static_cast<int>(k), 1);
        }
        work.begin(model_, stage, poses_, now.h, starts);
        now.meet(of.time, of.gamma);
        if (from != NewtonStart::guess) work.start_from(from, starts);
        for (std::size_t k = 0; k < home.size(); ++k) {
          if (before[k] == none) course.start(static_cast<int>(k), work);
        }
        refill = false;
      }
      const auto verdicts = course.go_on(work, work.newton(model_, Course::whole));
      lanes += T::lanes;
      bool ended = false;
      for (std::size_t k = 0; k < home.size(); ++k) {
        if (home[k] == none) continue;
        ++iterations;
        if (verdicts[k] == NewtonVerdict::go_on) continue;
        if (verdicts[k] == NewtonVerdict::converged) {
          if (!ended) {
            work.end(model_, poses_);
            judge.ended(poses_);
          }
          ended = true;
          judge.judged(static_cast<int>(k), home[k]);
        } else {
          failed.push_back(home[k]);
        }
        home[k] = none;
        refill = true;
      }
    }
  }

  void lose(const Step& now, std::size_t strand, std::string_view reason) {
    now.strands.lose(strand);
    lost_.push_back({strand, reason});
  }

  const Model& model_;
  const LaneMethod& method_;
  double tolerance_, left_;
  int iterations_;
  StepPoses poses_;
  std::vector<std::size_t> fresh_, others_;    // in first steps, and beyond them
  std::vector<std::size_t> failed_, waiting_;  // at a stage; to be tried again
  std::vector<std::size_t> stuck_, unsolved_;  // at some stage, sorted; in the end
  LaneStrands<Model> some_;                    // that take a step in parts
  std::vector<Loss> lost_;
};

}  // namespace tress::models
