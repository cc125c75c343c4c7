#pragma once

#include <vector>

#include "contract/basics.h"
#include "models/reduced/tree/tree_tangent.h"

namespace tress::models {

/// x = S^T mu for the S of a TreeTangent without couplings: the sweeps of its product in
/// reverse. Wrenches hang on the starts of segments in S, states are passed to their
/// tips; transposed, it is the other way round. O(segments). What the sweeps leave at the
/// segments and the root does not depend on the weights of S: the columns of unknowns
/// for other weights give the products with these.
template <class Shape>
class TransposedProduct {
 public:
  /// Writes x = S^T mu, both of tangent.unknowns() numbers.
  void compute(const TreeTangent<Shape>& tangent, In mu, Out x) {
    const std::size_t root = Shape::dofs * tangent.segments.size();
    by_tip_.resize(tangent.segments.size());
    by_state_.assign(tangent.segments.size(), State::Zero());
    of_root_.setZero();
    at_root_.setZero();
    if (tangent.free_root) {
      multiply_transposed<1, false>(tangent.root.lift,
                                    Eigen::Map<const OfRoot>(&mu[root]), of_root_);
    }
    rows_.resize(by_tip_.size());
    for (std::size_t i = 0; i < by_tip_.size(); ++i) {
      rows_[i] = rows(tangent, i, mu);
      multiply_transposed<1, false>(tangent.segments[i].lift, rows_[i], by_tip_[i]);
    }
    for (std::size_t i = by_tip_.size(); i-- > 0;) {
      const SegmentTangent<Shape>& segment = tangent.segments[i];
      multiply_transposed<1, true>(segment.tip, by_tip_[i], by_state_[i]);
      Eigen::Matrix<double, Shape::columns, 1> all;
      multiply_transposed<1, false>(segment.local, rows_[i], all);
      multiply_transposed<1, true>(segment.transfer, by_state_[i], all);
      for (int k = 0; k < Shape::dofs; ++k) {
        x[Shape::dofs * i + static_cast<std::size_t>(k)] = all[Shape::states + k];
      }
      const int parent = tangent.parent[i];
      State& start = parent < 0 ? at_root_ : by_state_[static_cast<std::size_t>(parent)];
      add(part<Shape::states, 1>(all, 0, 0), start);
    }
    if (!tangent.free_root) return;
    compute_root(tangent.root, mu.subspan(root), x.subspan(root));
  }
  /// Writes the product of the root's unknowns with a matrix for other weights, after
  /// compute().
  void compute_root(const RootTangent<Shape>& root, In mu, Out x) const {
    Eigen::Map<OfRoot> to(x.data());
    multiply_transposed<1, false>(root.local, Eigen::Map<const OfRoot>(mu.data()), to);
    multiply_transposed<1, true>(root.transfer, at_root_, to);
  }

  /// State of a tip.
  using State = Eigen::Matrix<double, Shape::states, 1>;
  /// Wrench on a segment.
  using Wrench = Eigen::Matrix<double, Shape::wrench, 1>;
  /// Equations of a segment.
  using Rows = Eigen::Matrix<double, Shape::rows, 1>;
  /// Returns what compute() found for the state of the tip of segment i.
  const State& by_state(std::size_t i) const { return by_state_[i]; }
  /// Returns what compute() found for the wrench on the tip of segment i.
  const Wrench& by_tip(std::size_t i) const { return by_tip_[i]; }
  /// Returns what compute() found for the state of the root.
  const State& at_root() const { return at_root_; }
  /// Returns what compute() found for the wrench on the root.
  const Wrench& by_root() const { return of_root_; }
  /// Returns what compute() found for the rows [w; r] of segment i.
  const Rows& rows(std::size_t i) const { return rows_[i]; }

 private:
  using OfRoot = Eigen::Matrix<double, 6, 1>;

  /// Derivatives by the wrench at a segment's start and by its own equations.
  Rows rows(const TreeTangent<Shape>& tangent, std::size_t i, In mu) const {
    Rows all;
    const int parent = tangent.parent[i];
    copy(parent < 0 ? of_root_ : by_tip_[static_cast<std::size_t>(parent)],
         part<Shape::wrench, 1>(all, 0, 0));
    for (int k = 0; k < Shape::dofs; ++k) {
      all[Shape::wrench + k] = mu[Shape::dofs * i + static_cast<std::size_t>(k)];
    }
    return all;
  }

  std::vector<Wrench> by_tip_;   // of each segment: by the wrench on its tip
  std::vector<State> by_state_;  // of each segment: by the state of its tip
  std::vector<Rows> rows_;       // of each segment
  State at_root_;                // by the state of the root
  Wrench of_root_;               // by the wrench on the root
};

}  // namespace tress::models
