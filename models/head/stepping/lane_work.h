#pragma once

#include <algorithm>
#include <vector>

#include "contract/system.h"
#include "math/lane_choice.h"
#include "models/head/lane_numbers.h"
#include "models/head/stepping/lane_method.h"
#include "models/motion/root_motion.h"

namespace tress::models {

/// Of a head at the start of a step, at a stage of it, and at its end.
struct StepPoses {
  RootPose from, at, to;
};

/// Whence Newton's iteration begins: from the guess, from zero acceleration, or from the
/// acceleration that ends all motion.
enum class NewtonStart { guess, zero, standstill };

/// The equations of a stage (models/head/stepping/lane_method.h) of as many strands as a
/// pack has lanes. Model: see models/head/stepping/stepped_model.h.
template <class Model>
class LaneWork {
 public:
  using T = typename Model::Real;

  LaneWork(const Model& model, const LaneMethod& method)
      : elements(model.elements()),
        state(4 * model.unknowns() + 2),
        after(state),
        q_bar(model.unknowns()),
        q(q_bar),
        v(q_bar),
        step(q_bar),
        scratch(model),
        method_(method),
        size_(model.unknowns()),
        v_bar_(q_bar),
        a_(q_bar) {}

  // At t_n what is known of the strands, as far as the method keeps it: q, v, the
  // acceleration a_0 of the last step and the one before, a_1; the lengths of both steps,
  // 0: none. `after`: once the stage is solved.
  typename Model::Strand strand;
  std::vector<typename Model::Element> elements;
  std::vector<T> state, after;

  std::vector<T> q_bar, q, v, step;  // q, v: at a
  typename Model::Scratch scratch;

  std::size_t size() const { return size_; }
  T* a() { return a_.data(); }
  const LaneMethod& method() const { return method_; }

  /// States the equations of a stage, for roots that move so in h. `starts`: 1 in lanes
  /// that need a guess of a, 0 in those that have come closer.
  void begin(const Model& model, std::size_t stage, const StepPoses& poses, double h,
             const T& starts) {
    const LaneStage& of = method_.stages[stage];
    stage_ = stage;
    h_ = h;
    T *const q_n = state.data(), *const v_n = q_n + size_;
    const T *const a_0 = v_n + size_, *const a_1 = a_0 + size_;
    const T ahead = this->ahead();
    for (std::size_t k = 0; k < size_; ++k) {
      v_bar_[k] = v_n[k] + T(h * of.rate[0]) * a_0[k];
      v_bar_[k] = v_bar_[k] + T(h * of.rate[1]) * a_1[k];
      v[k] = v_n[k] + T(h * of.drift[0]) * a_0[k];
      v[k] = v[k] + T(h * of.drift[1]) * a_1[k];
      const T guess = a_0[k] + ahead * (a_0[k] - a_1[k]);
      a_[k] = where_less(T(0), starts, guess, a_[k]);
    }
    model.predict(strand, poses.from, poses.at, of.time * h, q_n, v.data(), q_bar.data());
    clamp_ = model.clamp(strand, poses.at);
    const double s = of.gamma * h;
    weights = {1, s, s * s};
    if constexpr (Model::takes_stresses) {
      model.take_stresses(strand, q_n, starts, scratch);
    }
    place();
  }
  /// In lanes that start, from elsewhere than the guess.
  void start_from(NewtonStart from, const T& starts) {
    const T still = from == NewtonStart::zero ? T(0) : T(-1 / weights.vel);
    for (std::size_t k = 0; k < size_; ++k) {
      a_[k] = where_less(T(0), starts, still * v_bar_[k], a_[k]);
    }
    place();
  }
  void place() {
    const T pos(weights.pos), vel(weights.vel);
    for (std::size_t k = 0; k < size_; ++k) {
      q[k] = q_bar[k] + pos * a_[k];
      v[k] = v_bar_[k] + vel * a_[k];
    }
  }
  /// Writes `after`.
  void end(const Model& model, const StepPoses& poses) {
    const std::size_t n = size_;
    after = state;
    T *const q_n = after.data(), *const v_n = q_n + n, *const a_0 = v_n + n,
             *const a_1 = a_0 + n, *const lengths = a_1 + n;
    const LaneStage& of = method_.stages[stage_];
    if (of.gamma == 0) {
      std::ranges::copy(a_, a_0);
      return;
    }
    if (stage_ + 1 < method_.stages.size()) {
      std::ranges::copy(a_, a_1);
      return;
    }
    if (of.time == 1) {
      std::ranges::copy(q, q_n);
      std::ranges::copy(v, v_n);
    } else {
      model.predict(strand, poses.from, poses.to, h_, state.data(), v.data(), q_n);
      for (std::size_t k = 0; k < n; ++k) v_n[k] += T(h_) * a_[k];
    }
    if (method_.accelerations > 1) {
      std::copy_n(a_0, n, a_1);
      lengths[1] = lengths[0];
      lengths[0] = T(h_);
    }
    std::ranges::copy(a_, a_0);
  }

  /// After end() of the last stage, of the method's estimate.
  void difference(T* dq, T* dv) const {
    const LaneEstimate& by = *method_.estimate;
    const T *const a_0 = state.data() + 2 * size_, *const a_1 = a_0 + size_;
    const auto sum = [&](double scale, const std::array<double, 3>& of, std::size_t k) {
      return T(scale * of[0]) * a_0[k] + T(scale * of[1]) * a_1[k] +
             T(scale * of[2]) * a_[k];
    };
    for (std::size_t k = 0; k < size_; ++k) {
      dq[k] = sum(h_ * h_, by.drift, k);
      dv[k] = sum(h_, by.rate, k);
    }
  }

  /// The size of corrections that are rounding errors of places.
  double resolved(const Model& model, int lane) const {
    return model.resolved(strand, weights, lane);
  }
  /// step = S^-1 r; its size, per lane. Where corrections are `whole`, the stresses that
  /// the last one has found serve this one; at first those at the start of the step.
  T newton(const Model& model, bool whole) {
    if constexpr (Model::takes_stresses) {
      if (!whole) model.take_stresses(strand, q.data(), T(1), scratch);
    }
    return model.newton(strand, elements.data(), clamp_, weights, q.data(), v.data(), a(),
                        step.data(), scratch);
  }
  /// The same with the matrix of the last newton().
  T again(const Model& model) {
    return model.again(strand, elements.data(), clamp_, weights, q.data(), v.data(), a(),
                       step.data(), scratch);
  }
  void move(const T& part, const T* by) {
    for (std::size_t k = 0; k < size_; ++k) a_[k] -= part * by[k];
    place();
  }

  Weights weights;

 private:
  /// Of the line through the known accelerations: from a_0 on, over what lies between a_1
  /// and a_0; 0 if there is one alone. Those of the last steps are at their last stages.
  T ahead() const {
    const double time = method_.stages[stage_].time;
    if (stage_ > method_.first()) return T(-time / method_.stages[stage_ - 1].time);
    const T& last = state[4 * size_];
    const T& before = state[4 * size_ + 1];
    const double at = method_.stages.back().time;
    const T way = T(time * h_) + T(1 - at) * last,
            between = T(at) * last + T(1 - at) * before;
    return where_less(T(0), before, way / between, T(0));
  }

  const LaneMethod& method_;
  typename Model::Clamp clamp_;
  std::size_t size_, stage_ = 0;
  double h_ = 0;
  std::vector<T> v_bar_, a_;
};

}  // namespace tress::models
