#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>

#include "linear/dense_factor.h"
#include "models/reduced/tree/tree_tangent.h"

namespace tress::models {

/// The couplings of a tangent in terms of all unknowns: the dependence of each y on them,
/// and the contribution of y to their equations. Both take one walk from the far end of
/// each coupling to the root, O(N). The product of the two is O(N^2) per coupling.
template <class Shape>
class CoupledMatrix {
 public:
  /// dense += the couplings of the tangent.
  void add(const TreeTangent<Shape>& tangent, Eigen::MatrixXd& dense) {
    if (tangent.couplings.empty()) return;
    const auto rows = rank * static_cast<Eigen::Index>(tangent.couplings.size());
    by_.setZero(rows, dense.cols());
    onto_.setZero(dense.rows(), rows);
    int row = 0;
    for (const TreeCoupling<Shape>& coupling : tangent.couplings) {
      walk(tangent, coupling, row);
      row += rank;
    }
    add_dense_product(onto_, by_, dense);
  }

 private:
  static constexpr int states = Shape::states, wrench = Shape::wrench, n = Shape::dofs;
  static constexpr int rank = TreeCoupling<Shape>::rank;

  /// Visits each end once, with the segments on its way to the root.
  void walk(const TreeTangent<Shape>& tangent, const TreeCoupling<Shape>& coupling,
            int row) {
    std::array<const typename TreeCoupling<Shape>::End*, 4> left;
    for (std::size_t a = 0; a < 4; ++a) left[a] = &coupling.ends[a];
    std::ranges::sort(left, std::ranges::greater{},
                      [](const auto* end) { return end->segment; });
    for (std::size_t a = 0; a < 4; ++a) {
      if (left[a] == nullptr) continue;
      Eigen::Matrix<double, rank, states> of_tip;  // dy/d(state of the tip)
      Eigen::Matrix<double, wrench, rank> load;    // on the tip by y
      of_tip.setZero();
      load.setZero();
      for (int i = left[a]->segment; i >= 0;) {
        const auto at = static_cast<std::size_t>(i);
        const SegmentTangent<Shape>& segment = tangent.segments[at];
        Eigen::Matrix<double, rank, Shape::columns> by;
        by.setZero();
        add_pulled(of_tip, segment, by);
        Eigen::Matrix<double, Shape::rows, rank> onto = product(segment.lift, load);
        for (auto& end : left) {
          if (end == nullptr || end->segment != i) continue;
          models::add(end->by, by);
          models::add(end->onto, onto);
          end = nullptr;
        }
        copy(part<rank, n>(by, 0, states), part<rank, n>(by_, row, n * i));
        copy(part<n, rank>(onto, wrench, 0), part<n, rank>(onto_, n * i, row));
        copy(part<rank, states>(by, 0, 0), of_tip);
        copy(part<wrench, rank>(onto, 0, 0), load);
        i = tangent.parent[at];
      }
      if (!tangent.free_root) continue;
      const int root = n * static_cast<int>(tangent.parent.size());
      add_product(of_tip, tangent.root.transfer, part<rank, 6>(by_, row, root));
      add_product(tangent.root.lift, load, part<6, rank>(onto_, root, row));
    }
  }

  Eigen::MatrixXd by_, onto_;  // (4 couplings x unknowns), (unknowns x 4 couplings)
};

}  // namespace tress::models
