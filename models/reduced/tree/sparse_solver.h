#pragma once

#include <algorithm>
#include <numeric>
#include <utility>

#include "contract/pattern.h"
#include "linear/klu.h"
#include "models/reduced/tree/tree_solver.h"

namespace tress::models {

/// The equations of TreeTangent without elimination: per segment its unknowns x, the
/// state of its tip and the wrench at its start, in one sparse matrix for KLU.
template <class Shape>
class SparseTreeSolver final : public TreeSolver<Shape> {
 public:
  /// Allocates for tangents with the parents and the root of `structure`.
  explicit SparseTreeSolver(const TreeTangent<Shape>& structure)
      : pattern_(make_pattern(structure)),
        // Turning a nearly straight strand about its axis moves almost no mass, so small
        // pivots are physical. Only a zero is singular.
        klu_(pattern_, 0) {
    values_.resize(static_cast<std::size_t>(pattern_.nonzeros()));
    rhs_.resize(static_cast<std::size_t>(pattern_.rows));
    left_.resize(rhs_.size());
  }

  Status factor(const TreeTangent<Shape>& tangent) noexcept override {
    segments_ = tangent.parent.size();
    free_root_ = tangent.free_root;
    std::fill(values_.begin(), values_.end(), 0.0);
    std::size_t entry = 0;
    emit(tangent, [&](int, int, double value) {
      values_[static_cast<std::size_t>(place_[entry++])] += value;
    });
    return klu_.factor(values_);
  }

  Status solve(In b, Out x) noexcept override {
    std::fill(rhs_.begin(), rhs_.end(), 0.0);
    for (std::size_t i = 0; i < segments_; ++i) {
      for (std::size_t k = 0; k < n; ++k) rhs_[stride * i + k] = b[n * i + k];
    }
    const std::size_t last = free_root_ ? 6 : 0;
    for (std::size_t k = 0; k < last; ++k) {
      rhs_[stride * segments_ + k] = b[n * segments_ + k];
    }
    const Status status = refined_solve();
    for (std::size_t i = 0; i < segments_; ++i) {
      for (std::size_t k = 0; k < n; ++k) x[n * i + k] = rhs_[stride * i + k];
    }
    for (std::size_t k = 0; k < last; ++k) {
      x[n * segments_ + k] = rhs_[stride * segments_ + k];
    }
    return status;
  }

 private:
  /// KLU chooses pivots for sparsity, down to a thousandth of the largest, which loses up
  /// to five digits. One step of iterative refinement restores them.
  Status refined_solve() noexcept {
    left_ = rhs_;
    Status status = klu_.solve(rhs_);
    if (status != Status::ok) return status;
    for (std::size_t j = 0; j < rhs_.size(); ++j) {
      for (int k = pattern_.start[j]; k < pattern_.start[j + 1]; ++k) {
        const auto at = static_cast<std::size_t>(k);
        left_[static_cast<std::size_t>(pattern_.row[at])] -= values_[at] * rhs_[j];
      }
    }
    status = klu_.solve(left_);
    for (std::size_t i = 0; i < rhs_.size(); ++i) rhs_[i] += left_[i];
    return status;
  }

  // Offsets inside a segment: rows are [r; state of the tip; wrench], columns [x; s; w].
  static constexpr int n = Shape::dofs, states = Shape::states, wrench = Shape::wrench;
  static constexpr int stride = n + states + wrench;
  static constexpr int of_state = n, of_wrench = n + states;

  template <class Sink, class Block>
  static void put(Sink& sink, int row, int column, double factor, const Block& block) {
    for (int j = 0; j < Block::ColsAtCompileTime; ++j) {
      for (int i = 0; i < Block::RowsAtCompileTime; ++i) {
        sink(row + i, column + j, factor * block(i, j));
      }
    }
  }

  template <class Sink>
  static void put_identity(Sink& sink, int row, int column, int size) {
    for (int i = 0; i < size; ++i) sink(row + i, column + i, 1.0);
  }

  /// Every entry of the matrix in a fixed order; entries may repeat and add up.
  template <class Sink>
  static void emit(const TreeTangent<Shape>& tangent, Sink sink) {
    const int root = stride * static_cast<int>(tangent.parent.size());
    for (std::size_t i = 0; i < tangent.parent.size(); ++i) {
      const SegmentTangent<Shape>& segment = tangent.segments[i];
      const int at = stride * static_cast<int>(i);
      const int parent = tangent.parent[i];
      const auto lift_w = part<wrench, wrench>(segment.lift, 0, 0);
      const auto lift_r = part<n, wrench>(segment.lift, wrench, 0);

      put(sink, at, at, 1, part<n, n>(segment.local, wrench, states));
      put(sink, at, at + of_state, 1, product(lift_r, segment.tip));
      put_identity(sink, at + of_state, at + of_state, states);
      put(sink, at + of_state, at, -1, part<states, n>(segment.transfer, 0, states));
      put_identity(sink, at + of_wrench, at + of_wrench, wrench);
      put(sink, at + of_wrench, at, -1, part<wrench, n>(segment.local, 0, states));
      put(sink, at + of_wrench, at + of_state, -1, product(lift_w, segment.tip));

      // Contribution of the state at the start: the parent's tip, or a free root.
      const auto r_of_s = part<n, states>(segment.local, wrench, 0);
      const auto s_of_s = part<states, states>(segment.transfer, 0, 0);
      const auto w_of_s = part<wrench, states>(segment.local, 0, 0);
      if (parent >= 0) {
        const int start = stride * parent;
        put(sink, at, start + of_state, 1, r_of_s);
        put(sink, at + of_state, start + of_state, -1, s_of_s);
        put(sink, at + of_wrench, start + of_state, -1, w_of_s);
        const auto& below = tangent.segments[static_cast<std::size_t>(parent)].lift;
        put(sink, start, at + of_wrench, 1, part<n, wrench>(below, wrench, 0));
        put(sink, start + of_wrench, at + of_wrench, -1,
            part<wrench, wrench>(below, 0, 0));
      } else if (tangent.free_root) {
        const auto start = part(tangent.root.transfer);
        put(sink, at, root, 1, product(r_of_s, start));
        put(sink, at + of_state, root, -1, product(s_of_s, start));
        put(sink, at + of_wrench, root, -1, product(w_of_s, start));
        put(sink, root, at + of_wrench, 1, tangent.root.lift);
      }
    }
    if (tangent.free_root) put(sink, root, root, 1, tangent.root.local);
  }

  /// Makes the pattern and fills place_, the index of each emitted entry among its
  /// values.
  Pattern make_pattern(const TreeTangent<Shape>& structure) {
    std::vector<std::pair<int, int>> entries;  // column, row
    emit(structure,
         [&](int row, int column, double) { entries.emplace_back(column, row); });
    std::vector<std::pair<int, int>> sorted = entries;
    std::sort(sorted.begin(), sorted.end());
    sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
    Pattern pattern;
    pattern.rows = pattern.cols = stride * static_cast<int>(structure.parent.size()) +
                                  (structure.free_root ? 6 : 0);
    pattern.start.assign(static_cast<std::size_t>(pattern.cols) + 1, 0);
    for (const auto& [column, row] : sorted) {
      ++pattern.start[static_cast<std::size_t>(column) + 1];
      pattern.row.push_back(row);
    }
    std::partial_sum(pattern.start.begin(), pattern.start.end(), pattern.start.begin());
    for (const auto& entry : entries) {
      place_.push_back(static_cast<int>(
          std::lower_bound(sorted.begin(), sorted.end(), entry) - sorted.begin()));
    }
    return pattern;
  }

  std::vector<int> place_;
  Pattern pattern_;
  KluSolver klu_;
  std::vector<double> values_, rhs_, left_;
  std::size_t segments_ = 0;
  bool free_root_ = false;
};

}  // namespace tress::models
