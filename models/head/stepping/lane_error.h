#pragma once

#include <algorithm>
#include <vector>

#include "math/lane_choice.h"
#include "models/head/stepping/lane_work.h"

namespace tress::models {

/// Size of the estimated error of steps, per lane, by the points that it moves: the
/// largest of |dx|/L and |du| sqrt(L/g)/L over the root and the tips of elements, L the
/// strand's length along its elements and g = 9.81 m/s^2, and a fifteenth of that of
/// coordinates over their typical sizes. So ErrorNorm measures a strand by itself
/// (integrators/control/error_norm.h), but for its L, the sum of the chords at the start,
/// which is shorter for elements that are arcs.
template <class Model>
class LaneError {
 public:
  using T = typename Model::Real;
  using V = Vec3<T>;

  explicit LaneError(const Model& model)
      : x_(model.elements() + 1),
        u_(x_),
        dq_(model.unknowns()),
        dv_(dq_),
        q_(dq_),
        v_(dq_) {}

  /// Of `work` at the end of a step, at this pose; not a number where something is not.
  T of(const Model& model, const LaneWork<Model>& work, const RootPose& pose) {
    work.difference(dq_.data(), dv_.data());
    for (std::size_t k = 0; k < q_.size(); ++k) {
      q_[k] = work.q[k] - dq_[k];
      v_[k] = work.v[k] - dv_[k];
    }
    model.positions(work.strand, pose.frame, work.q.data(),
                    [&](std::size_t i, const V& at) { x_[i] = at; });
    model.velocities(work.strand, pose, work.q.data(), work.v.data(),
                     [&](std::size_t i, const V& at) { u_[i] = at; });
    T far(0), fast(0), finite(0);  // squares; the last: 0 or NaN
    const auto look = [&](const V& d, T& most) {
      const T square = dot(d, d);
      finite += square - square;
      most = larger(most, square);
    };
    model.positions(work.strand, pose.frame, q_.data(),
                    [&](std::size_t i, const V& at) { look(at - x_[i], far); });
    model.velocities(work.strand, pose, q_.data(), v_.data(),
                     [&](std::size_t i, const V& at) { look(at - u_[i], fast); });
    // In units of the head g is 1.
    const T by_length = T(1) / length(model, work.strand);
    const T of_points =
        square_root(larger(by_length * by_length * far, by_length * fast));
    return larger(of_points,
                  T(coordinate_weight) * model.coordinate_size(work.strand, dq_.data())) +
           finite;
  }

  static T length(const Model& model, const typename Model::Strand& strand) {
    return T(static_cast<double>(model.elements())) * model.element_length(strand);
  }

 private:
  static constexpr double coordinate_weight = 1. / 15;

  std::vector<V> x_, u_;  // (points)
  std::vector<T> dq_, dv_, q_, v_;
};

}  // namespace tress::models
