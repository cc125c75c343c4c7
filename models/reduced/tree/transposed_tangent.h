#pragma once

#include <vector>

#include "contract/basics.h"
#include "models/reduced/tree/tree_tangent.h"

namespace tress::models {

/// x = S^T mu for the S of a TreeTangent without couplings: the sweeps of its product in
/// reverse. Wrenches hang on the starts of segments in S, states are passed to their
/// tips; transposed, it is the other way round. O(segments).
template <class Shape>
class TransposedProduct {
 public:
  /// Writes x = S^T mu, both of tangent.unknowns() numbers.
  void compute(const TreeTangent<Shape>& tangent, In mu, Out x) {
    const std::size_t root = Shape::dofs * tangent.segments.size();
    by_tip_.resize(tangent.segments.size());
    by_state_.assign(tangent.segments.size(), State::Zero());
    Wrench of_root = Wrench::Zero();
    State at_root = State::Zero();
    Eigen::Matrix<double, 6, 1> mu_root = Eigen::Matrix<double, 6, 1>::Zero();
    if (tangent.free_root) {
      mu_root = Eigen::Map<const Eigen::Matrix<double, 6, 1>>(&mu[root]);
      of_root.noalias() = tangent.root.lift.transpose() * mu_root;
    }
    for (std::size_t i = 0; i < by_tip_.size(); ++i) {
      by_tip_[i].noalias() =
          tangent.segments[i].lift.transpose() * rows(tangent, i, of_root, mu);
    }
    for (std::size_t i = by_tip_.size(); i-- > 0;) {
      const SegmentTangent<Shape>& segment = tangent.segments[i];
      by_state_[i].noalias() += segment.tip.transpose() * by_tip_[i];
      Eigen::Matrix<double, Shape::columns, 1> all;
      all.noalias() = segment.local.transpose() * rows(tangent, i, of_root, mu);
      all.noalias() += segment.transfer.transpose() * by_state_[i];
      for (int k = 0; k < Shape::dofs; ++k) {
        x[Shape::dofs * i + static_cast<std::size_t>(k)] = all[Shape::states + k];
      }
      const int parent = tangent.parent[i];
      State& start = parent < 0 ? at_root : by_state_[static_cast<std::size_t>(parent)];
      start += all.template head<Shape::states>();
    }
    if (!tangent.free_root) return;
    Eigen::Map<Eigen::Matrix<double, 6, 1>> x_root(&x[root]);
    x_root.noalias() = tangent.root.local.transpose() * mu_root;
    x_root.noalias() += tangent.root.transfer.transpose() * at_root;
  }

 private:
  using State = Eigen::Matrix<double, Shape::states, 1>;
  using Wrench = Eigen::Matrix<double, Shape::wrench, 1>;
  using Rows = Eigen::Matrix<double, Shape::rows, 1>;

  /// Derivatives by the wrench at a segment's start and by its own equations.
  Rows rows(const TreeTangent<Shape>& tangent, std::size_t i, const Wrench& of_root,
            In mu) const {
    Rows all;
    const int parent = tangent.parent[i];
    all.template head<Shape::wrench>() =
        parent < 0 ? of_root : by_tip_[static_cast<std::size_t>(parent)];
    for (int k = 0; k < Shape::dofs; ++k) {
      all[Shape::wrench + k] = mu[Shape::dofs * i + static_cast<std::size_t>(k)];
    }
    return all;
  }

  std::vector<Wrench> by_tip_;   // of each segment: by the wrench on its tip
  std::vector<State> by_state_;  // of each segment: by the state of its tip
};

}  // namespace tress::models
