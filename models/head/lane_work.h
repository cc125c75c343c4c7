#pragma once

#include <vector>

#include "contract/system.h"
#include "models/head/lane_numbers.h"
#include "models/motion/root_motion.h"

namespace tress::models {

/// The equations of a step of backward_euler,
///
///     r(t + h, q, v, a) = 0,    q = q_n + h v_n + h^2 a,    v = v_n + h a,
///
/// of as many strands as a pack has lanes. Model: see models/head/stepping_head.h.
template <class Model>
class LaneWork {
 public:
  using T = typename Model::Real;

  explicit LaneWork(const Model& model)
      : elements(model.elements()),
        state(3 * model.unknowns()),
        q_bar(model.unknowns()),
        q(q_bar),
        v(q_bar),
        step(q_bar),
        scratch(model),
        size_(model.unknowns()) {}

  // At t: what is known of the strands, q, v and the guess of a, which solutions replace.
  typename Model::Strand strand;
  std::vector<typename Model::Element> elements;
  std::vector<T> state;

  std::vector<T> q_bar, q, v, step;  // q, v: at a
  typename Model::Scratch scratch;

  std::size_t size() const { return size_; }
  T* q_n() { return state.data(); }
  T* v_n() { return q_n() + size_; }
  T* a() { return v_n() + size_; }

  /// States the equations, for roots that move from one pose to the other in h.
  void begin(const Model& model, const RootPose& from, const RootPose& to, double h) {
    model.renew(elements.data(), model.clamp(strand, from), q_n(), v_n());
    model.predict(strand, from, to, h, q_n(), v_n(), q_bar.data());
    clamp_ = model.clamp(strand, to);
    weights = {1, h, h * h};
    place();
  }
  void place() {
    const T pos(weights.pos), vel(weights.vel);
    for (std::size_t k = 0; k < size_; ++k) {
      q[k] = q_bar[k] + pos * a()[k];
      v[k] = v_n()[k] + vel * a()[k];
    }
  }
  /// The size of corrections that are rounding errors of places.
  double resolved(const Model& model, int lane) const {
    return model.resolved(strand, weights, lane);
  }
  /// step = S^-1 r; its size, per lane.
  T newton(const Model& model) {
    return model.newton(strand, elements.data(), clamp_, weights, q.data(), v.data(), a(),
                        step.data(), scratch);
  }
  /// The same with the matrix of the last newton().
  T again(const Model& model) {
    return model.again(strand, elements.data(), clamp_, weights, q.data(), v.data(), a(),
                       step.data(), scratch);
  }
  void move(const T& part, const T* by) {
    for (std::size_t k = 0; k < size_; ++k) a()[k] -= part * by[k];
    place();
  }

  Weights weights;

 private:
  typename Model::Clamp clamp_;
  std::size_t size_;
};

}  // namespace tress::models
