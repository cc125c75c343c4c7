#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "models/head/stepping/lane_work.h"
#include "models/head/stepping/newton_course.h"

namespace tress::models {

/// The step of one strand on which iterations side by side have failed, in all lanes of a
/// pack alike: damped iterations as integrators/stage.h's, from the guess, from zero
/// acceleration and from standstill; then 2, 4, ... shorter steps.
template <class Model>
class LoneStrand {
 public:
  using T = typename Model::Real;
  using PoseAt = std::function<RootPose(double part)>;  // of the step, 0 to 1
  /// Finds loads of bodies there, of a stage of gamma h = `share` of the step, from
  /// `work` as it is.
  using Meet = std::function<void(double part, double share)>;

  LoneStrand(const Model& model, double tolerance, int most_iterations,
             LaneWork<Model>& work)
      : model_(model),
        tolerance_(tolerance),
        iterations_(most_iterations),
        work_(work),
        n_(work.size()) {}

  /// h: without units, as the poses. True: work.state is that after the step.
  bool solve(const PoseAt& pose, const Meet& meet, double h) {
    const std::vector<T> start = work_.state;
    const auto elements = work_.elements;
    for (int parts = 1; parts <= most_parts; parts *= 2) {
      shortened = parts > 1;
      work_.state = start;
      work_.elements = elements;
      if (in_parts(pose, meet, h, parts)) return true;
    }
    return false;
  }

  long iterations = 0;
  bool shortened = false;

 private:
  static constexpr int most_parts = 64;

  enum Start { guess, zero, standstill };

  bool damped_from_anywhere(Start first) {
    T* const a = work_.a();
    const std::vector<T> guessed(a, a + n_);
    for (int from = first; from <= standstill; ++from) {
      for (std::size_t k = 0; k < n_; ++k) {
        a[k] = from == guess  ? guessed[k]
               : from == zero ? T(0)
                              : T(-1 / work_.weights.vel) * work_.v_bar()[k];
      }
      work_.place();
      if (damped()) return true;
    }
    return false;
  }

  bool damped() {
    DampedCourse<Model> course(model_, tolerance_, iterations_);
    course.start(0, work_);
    NewtonVerdict verdict = NewtonVerdict::go_on;
    while (verdict == NewtonVerdict::go_on) {
      verdict = course.go_on(work_, work_.newton(model_, course.whole))[0];
      ++iterations;
    }
    iterations += course.iterations;
    return verdict == NewtonVerdict::converged;
  }

  bool in_parts(const PoseAt& pose, const Meet& meet, double h, int parts) {
    const LaneMethod& method = work_.method();
    // The only stage of the whole step has been tried from its guess.
    const bool tried = parts == 1 && method.stages.size() == 1;
    for (int i = 0; i < parts; ++i) {
      std::size_t k = method.first();
      if (i > 0 && renewed(pose(static_cast<double>(i) / parts))) k = 0;
      for (; k < method.stages.size(); ++k) {
        const LaneStage& stage = method.stages[k];
        const double at = (i + stage.time) / parts;
        const StepPoses poses{pose(static_cast<double>(i) / parts), pose(at),
                              pose(static_cast<double>(i + 1) / parts)};
        work_.begin(model_, k, poses, h / parts, T(1));
        meet(at, stage.gamma / parts);
        if (!solved(stage, tried ? zero : guess)) return false;
        work_.end(model_, poses);
        work_.state.swap(work_.after);
      }
    }
    return true;
  }
  /// Other lanes than the first go their own ways once corrections are damped.
  bool renewed(const RootPose& at) {
    T *const q = work_.state.data(), *const v = q + n_;
    const T some =
        model_.renew(work_.elements.data(), model_.clamp(work_.strand, at), q, v);
    return lane_of(some, 0) > 0;
  }
  bool solved(const LaneStage& stage, Start first) {
    if (stage.gamma > 0) return damped_from_anywhere(first);
    SingleCourse<Model> course;
    ++iterations;
    return course.go_on(work_, work_.newton(model_, course.whole))[0] ==
           NewtonVerdict::converged;
  }

  const Model& model_;
  double tolerance_;
  int iterations_;
  LaneWork<Model>& work_;
  std::size_t n_;
};

}  // namespace tress::models
