#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "models/reduced/tree/coupled_matrix.h"
#include "models/reduced/tree/tree_tangent.h"

namespace tress::models {

/// The dense matrix of all unknowns, as in [Bertails et al. 2006], but assembled in
/// O(N^2) by composite bodies [Featherstone's CRBA]. The bodies beyond a tip, with their
/// joints locked, are summed once from the free ends. Column block i then takes one walk
/// to the root and, for an exact Jacobian, one through the segments below.
template <class Shape>
class CompositeMatrix {
 public:
  /// `dense` has the size of all unknowns and must outlive this.
  CompositeMatrix(const TreeTangent<Shape>& structure, Eigen::MatrixXd& dense)
      : hanging_(structure.parent.size()),
        full_(structure.parent.size()),
        state_(structure.parent.size()),
        dense_(dense) {}

  /// Writes every entry.
  void assemble(const TreeTangent<Shape>& tangent) {
    compose(tangent);
    fill(tangent);
    if constexpr (!Shape::symmetric) coupled_.add(tangent, dense_);
  }

 private:
  static constexpr int states = Shape::states, wrench = Shape::wrench, n = Shape::dofs;
  using Hanging = Eigen::Matrix<double, wrench, states>;
  using Full = Eigen::Matrix<double, Shape::rows, Shape::columns>;
  template <int columns>
  using Load = Eigen::Matrix<double, wrench, columns>;

  /// full_[i] maps [s; x] of segment i to its [w; r] with all joints below it locked.
  void compose(const TreeTangent<Shape>& tangent) {
    at_root_.setZero();
    for (std::size_t i = 0; i < full_.size(); ++i) hanging_[i] = tangent.segments[i].tip;
    for (std::size_t i = full_.size(); i-- > 0;) {
      full_[i] = with_hanging(tangent.segments[i], hanging_[i]);
      const int parent = tangent.parent[i];
      add(part<wrench, states>(full_[i], 0, 0),
          parent < 0 ? at_root_ : hanging_[static_cast<std::size_t>(parent)]);
    }
  }

  void fill(const TreeTangent<Shape>& tangent) {
    dense_.setZero();
    const auto count = static_cast<int>(full_.size());
    for (int i = 0; i < count; ++i) {
      const auto at = static_cast<std::size_t>(i);
      put<n, n>(n * i, n * i, part<n, n>(full_[at], wrench, states));
      Load<n> load;
      copy(part<wrench, n>(full_[at], 0, states), load);
      walk_up<n>(tangent, tangent.parent[at], n * i, load);
      if constexpr (!Shape::symmetric) {
        walk_down<n>(tangent, at,
                     part<states, n>(tangent.segments[at].transfer, 0, states), n * i);
      }
    }
    if (!tangent.free_root) return;
    Eigen::Matrix<double, 6, 6> root = tangent.root.local;
    add_product(tangent.root.lift, product(at_root_, tangent.root.transfer), root);
    put<6, 6>(n * count, n * count, root);
    if constexpr (!Shape::symmetric) {
      walk_down<6>(tangent, full_.size(), part(tangent.root.transfer), n * count);
    }
  }

  /// Adds the load of column block `column` on the tip of `segment` to the residuals from
  /// there to the root; a symmetric matrix gets the mirror image too.
  template <int columns>
  void walk_up(const TreeTangent<Shape>& tangent, int segment, int column,
               Load<columns>& load) {
    while (segment >= 0) {
      const SegmentTangent<Shape>& at =
          tangent.segments[static_cast<std::size_t>(segment)];
      const Eigen::Matrix<double, Shape::rows, columns> lifted = product(at.lift, load);
      put<n, columns>(n * segment, column, part<n, columns>(lifted, wrench, 0));
      copy(part<wrench, columns>(lifted, 0, 0), load);
      segment = tangent.parent[static_cast<std::size_t>(segment)];
    }
    if (tangent.free_root) {
      put<6, columns>(n * static_cast<int>(full_.size()), column,
                      product(tangent.root.lift, load));
    }
  }

  template <int rows, int columns, class Block>
  void put(int row, int column, const Block& block) {
    copy(block, part<rows, columns>(dense_, row, column));
    if constexpr (Shape::symmetric) {
      copy(block, part<columns, rows>(dense_, column, row).transpose());
    }
  }

  /// Motion due to column block `column` of everything below `from` (the root if `from`
  /// is the number of segments).
  template <int columns>
  void walk_down(const TreeTangent<Shape>& tangent, std::size_t from,
                 Part<const double, states, columns> motion, int column) {
    const bool root = from == full_.size();
    moved_.assign(full_.size(), 0);
    if (!root) {
      moved_[from] = 1;
      copy(motion, state_[from]);
    }
    for (std::size_t i = root ? 0 : from + 1; i < full_.size(); ++i) {
      const int parent = tangent.parent[i];
      if (parent < 0 ? !root : moved_[static_cast<std::size_t>(parent)] == 0) continue;
      const Part<const double, states, columns> s =
          parent < 0 ? motion
                     : part<states, columns>(
                           std::as_const(state_[static_cast<std::size_t>(parent)]), 0, 0);
      moved_[i] = 1;
      multiply<1, false>(part<n, states>(full_[i], wrench, 0), s,
                         part<n, columns>(dense_, n * static_cast<int>(i), column));
      multiply<1, false>(part<states, states>(tangent.segments[i].transfer, 0, 0), s,
                         part<states, columns>(state_[i], 0, 0));
    }
  }

  std::vector<Hanging> hanging_;
  std::vector<Full> full_;
  std::vector<Eigen::Matrix<double, states, 6>> state_;
  std::vector<char> moved_;
  Hanging at_root_;
  CoupledMatrix<Shape> coupled_;
  Eigen::MatrixXd& dense_;
};

}  // namespace tress::models
