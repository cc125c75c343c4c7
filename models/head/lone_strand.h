#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "models/head/lane_work.h"
#include "models/head/newton_judge.h"

namespace tress::models {

/// The step of one strand on which Newton's iteration has failed, in all lanes of a pack
/// alike: damped iterations as integrators/stage.h's, from the guess, from zero
/// acceleration and from standstill; then 2, 4, ... shorter steps.
template <class Model>
class LoneStrand {
 public:
  using T = typename Model::Real;
  using PoseAt = std::function<RootPose(double part)>;  // of the step, 0 to 1

  LoneStrand(const Model& model, double tolerance, int iterations, LaneWork<Model>& work)
      : model_(model),
        tolerance_(tolerance),
        iterations_(iterations),
        work_(work),
        n_(work.size()) {}

  /// h: without units, as the poses. True: work's q, v and a are the solution.
  bool solve(const PoseAt& pose, double h) {
    const std::vector<T> start = work_.state;
    work_.begin(model_, pose(0), pose(1), h);
    if (damped_from_anywhere(start)) return true;
    for (int parts = 2; parts <= most_parts; parts *= 2) {
      shortened = true;
      work_.state = start;
      if (in_parts(pose, h, parts)) return true;
    }
    return false;
  }

  long iterations = 0;
  bool shortened = false;

 private:
  static constexpr int most_parts = 64;
  static constexpr int patience = 3;  // damped steps are shorter: more of them
  static constexpr double shortest = 1e-4;

  bool damped_from_anywhere(const std::vector<T>& start) {
    T* const a = work_.a();
    for (int from = 0; from < 3; ++from) {
      for (std::size_t k = 0; k < n_; ++k) {
        a[k] = from == 0   ? start[2 * n_ + k]
               : from == 1 ? T(0)
                           : T(-1 / work_.weights.vel) * work_.v_n()[k];
      }
      work_.place();
      if (damped()) return true;
    }
    return false;
  }

  bool damped() {
    const NewtonJudge::Rules rules =
        NewtonJudge::rules(tolerance_, iterations_, work_.resolved(model_, 0));
    for (int i = 0; i < patience * rules.iterations; ++i) {
      const double size = lane_of(work_.newton(model_), 0);
      ++iterations;
      if (!std::isfinite(size)) return false;
      if (size <= rules.tolerance) {
        work_.move(T(1), work_.step.data());
        return true;
      }
      if (!halve_until_smaller(size)) return size <= rules.rounding;
    }
    return false;
  }

  /// Takes the step, or the largest halving of it after which the next correction with
  /// the same matrix is smaller [Deuflhard 2011, section 3.3].
  bool halve_until_smaller(double size) {
    const std::vector<T> from(work_.a(), work_.a() + n_), step = work_.step;
    for (double part = 1; part >= shortest; part /= 2) {
      std::copy(from.begin(), from.end(), work_.a());
      work_.move(T(part), step.data());
      ++iterations;
      if (lane_of(work_.again(model_), 0) <= (1 - part / 4) * size) return true;
    }
    return false;
  }

  bool in_parts(const PoseAt& pose, double h, int parts) {
    for (int i = 0; i < parts; ++i) {
      const std::vector<T> start = work_.state;
      work_.begin(model_, pose(static_cast<double>(i) / parts),
                  pose(static_cast<double>(i + 1) / parts), h / parts);
      if (!damped_from_anywhere(start)) return false;
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
