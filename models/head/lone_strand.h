#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "models/head/lane_work.h"
#include "models/head/newton_course.h"

namespace tress::models {

/// The step of one strand on which iterations side by side have failed, in all lanes of a
/// pack alike: damped iterations as integrators/stage.h's, from the guess, from zero
/// acceleration and from standstill; then 2, 4, ... shorter steps.
template <class Model>
class LoneStrand {
 public:
  using T = typename Model::Real;
  using PoseAt = std::function<RootPose(double part)>;  // of the step, 0 to 1
  /// Finds loads of bodies that end one of so many parts there, from `work` as it is.
  using Meet = std::function<void(double part, int parts)>;

  LoneStrand(const Model& model, double tolerance, int most_iterations,
             LaneWork<Model>& work)
      : model_(model),
        tolerance_(tolerance),
        iterations_(most_iterations),
        work_(work),
        n_(work.size()) {}

  /// h: without units, as the poses. True: work's q, v and a are the solution.
  bool solve(const PoseAt& pose, const Meet& meet, double h) {
    const std::vector<T> start = work_.state;
    work_.begin(model_, pose(0), pose(1), h);
    meet(1, 1);
    if (damped_from_anywhere(start, Start::zero)) return true;
    for (int parts = 2; parts <= most_parts; parts *= 2) {
      shortened = true;
      work_.state = start;
      if (in_parts(pose, meet, h, parts)) return true;
    }
    return false;
  }

  long iterations = 0;
  bool shortened = false;

 private:
  static constexpr int most_parts = 64;

  enum Start { guess, zero, standstill };

  /// Of the starts, from `first` on.
  bool damped_from_anywhere(const std::vector<T>& start, Start first) {
    T* const a = work_.a();
    for (int from = first; from <= standstill; ++from) {
      for (std::size_t k = 0; k < n_; ++k) {
        a[k] = from == guess  ? start[2 * n_ + k]
               : from == zero ? T(0)
                              : T(-1 / work_.weights.vel) * work_.v_n()[k];
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
      verdict = course.go_on(work_, work_.newton(model_))[0];
      ++iterations;
    }
    iterations += course.iterations;
    return verdict == NewtonVerdict::converged;
  }

  bool in_parts(const PoseAt& pose, const Meet& meet, double h, int parts) {
    for (int i = 0; i < parts; ++i) {
      const std::vector<T> start = work_.state;
      work_.begin(model_, pose(static_cast<double>(i) / parts),
                  pose(static_cast<double>(i + 1) / parts), h / parts);
      meet(static_cast<double>(i + 1) / parts, parts);
      if (!damped_from_anywhere(start, Start::guess)) return false;
      if (i + 1 == parts) return true;
      std::copy(work_.q.begin(), work_.q.end(), work_.q_n());
      std::copy(work_.v.begin(), work_.v.end(), work_.v_n());
    }
    return true;
  }

  const Model& model_;
  double tolerance_;
  int iterations_;
  LaneWork<Model>& work_;
  std::size_t n_;
};

}  // namespace tress::models
