#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/reduced/tree_tangent.h"

namespace tress {

/// The dense matrix of all unknowns, as in [Bertails et al. 2006], but assembled in
/// O(N^2) by composite bodies [Featherstone's CRBA]: what hangs on a tip, with its joints
/// held, is summed up once from the free ends; column block i then takes one walk to the
/// root (and, for an exact tangent, one through the segments below).
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
  }

 private:
  static constexpr int states = Shape::states, wrench = Shape::wrench, n = Shape::dofs;
  using Hanging = Eigen::Matrix<double, wrench, states>;
  using Full = Eigen::Matrix<double, Shape::rows, Shape::columns>;
  template <int columns>
  using Motion = Eigen::Matrix<double, states, columns>;
  template <int columns>
  using Load = Eigen::Matrix<double, wrench, columns>;

  /// full_[i] maps [s; x] of segment i to its [w; r] with all segments below held still.
  void compose(const TreeTangent<Shape>& tangent) {
    at_root_.setZero();
    for (std::size_t i = 0; i < full_.size(); ++i) hanging_[i] = tangent.segments[i].tip;
    for (std::size_t i = full_.size(); i-- > 0;) {
      full_[i] = with_hanging(tangent.segments[i], hanging_[i]);
      const int parent = tangent.parent[i];
      (parent < 0 ? at_root_ : hanging_[static_cast<std::size_t>(parent)]) +=
          full_[i].template topLeftCorner<wrench, states>();
    }
  }

  void fill(const TreeTangent<Shape>& tangent) {
    dense_.setZero();
    const auto count = static_cast<Eigen::Index>(full_.size());
    for (Eigen::Index i = 0; i < count; ++i) {
      const auto at = static_cast<std::size_t>(i);
      dense_.template block<n, n>(n * i, n * i) =
          full_[at].template bottomRightCorner<n, n>();
      Load<n> load = full_[at].template topRightCorner<wrench, n>();
      walk_up<n>(tangent, tangent.parent[at], n * i, load);
      if constexpr (!Shape::symmetric) {
        walk_down<n>(tangent, at, tangent.segments[at].transfer.template rightCols<n>(),
                     n * i);
      }
    }
    if (!tangent.free_root) return;
    Eigen::Matrix<double, 6, 6> root = tangent.root.local;
    add_product(tangent.root.lift, product(at_root_, tangent.root.transfer), root);
    dense_.template block<6, 6>(n * count, n * count) = root;
    if constexpr (!Shape::symmetric) {
      walk_down<6>(tangent, full_.size(), tangent.root.transfer, n * count);
    }
  }

  /// The load that column block `column` puts on the tip of `segment` meets the residuals
  /// from there to the root; a symmetric matrix gets the mirror image too.
  template <int columns>
  void walk_up(const TreeTangent<Shape>& tangent, int segment, Eigen::Index column,
               Load<columns>& load) {
    while (segment >= 0) {
      const SegmentTangent<Shape>& at =
          tangent.segments[static_cast<std::size_t>(segment)];
      const Eigen::Matrix<double, Shape::rows, columns> lifted = product(at.lift, load);
      put<n, columns>(n * segment, column, lifted.template bottomRows<n>());
      load = lifted.template topRows<wrench>();
      segment = tangent.parent[static_cast<std::size_t>(segment)];
    }
    if (tangent.free_root) {
      put<6, columns>(n * static_cast<Eigen::Index>(full_.size()), column,
                      product(tangent.root.lift, load));
    }
  }

  template <int rows, int columns, class Block>
  void put(Eigen::Index row, Eigen::Index column, const Block& block) {
    dense_.template block<rows, columns>(row, column) = block;
    if constexpr (Shape::symmetric) {
      dense_.template block<columns, rows>(column, row) =
          dense_.template block<rows, columns>(row, column).transpose();
    }
  }

  /// Motion that column block `column` gives to everything below `from` (the root when
  /// `from` is the number of segments).
  template <int columns>
  void walk_down(const TreeTangent<Shape>& tangent, std::size_t from,
                 const Motion<columns>& motion, Eigen::Index column) {
    const bool root = from == full_.size();
    moved_.assign(full_.size(), 0);
    if (!root) {
      moved_[from] = 1;
      state_[from].template leftCols<columns>() = motion;
    }
    for (std::size_t i = root ? 0 : from + 1; i < full_.size(); ++i) {
      const int parent = tangent.parent[i];
      if (parent < 0 ? !root : moved_[static_cast<std::size_t>(parent)] == 0) continue;
      const Motion<columns> s =
          parent < 0
              ? motion
              : state_[static_cast<std::size_t>(parent)].template leftCols<columns>();
      moved_[i] = 1;
      dense_.template block<n, columns>(n * static_cast<Eigen::Index>(i), column) =
          product(full_[i].template bottomLeftCorner<n, states>(), s);
      state_[i].template leftCols<columns>() =
          product(tangent.segments[i].transfer.template leftCols<states>(), s);
    }
  }

  std::vector<Hanging> hanging_;
  std::vector<Full> full_;
  std::vector<Motion<6>> state_;
  std::vector<char> moved_;
  Hanging at_root_;
  Eigen::MatrixXd& dense_;
};

}  // namespace tress
