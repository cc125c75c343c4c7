#pragma once

#include "linear/dense_factor.h"
#include "models/reduced/tree/composite_matrix.h"
#include "models/reduced/tree/tree_solver.h"

namespace tress::models {

/// The dense matrix of all unknowns by Cholesky or LU, O(N^3).
template <class Shape>
class CompositeSolver final : public TreeSolver<Shape> {
 public:
  /// Allocates for tangents with the parents and the root of `structure`.
  explicit CompositeSolver(const TreeTangent<Shape>& structure)
      : dense_(structure.unknowns(), Shape::symmetric),
        composite_(structure, dense_.matrix) {}

  Status factor(const TreeTangent<Shape>& tangent) noexcept override {
    composite_.assemble(tangent);
    return dense_.factor();
  }

  Status solve(In b, Out x) noexcept override { return dense_.solve(b, x); }

 private:
  DenseFactor dense_;
  CompositeMatrix<Shape> composite_;
};

}  // namespace tress::models
