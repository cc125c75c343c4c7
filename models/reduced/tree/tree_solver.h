#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>

#include "contract/basics.h"
#include "models/reduced/tree/tree_tangent.h"

namespace tress::models {

/// Solver for the linear problem of a tree; all but `elastic_local` give the same x.
enum class TreeMethod {
  recursive,        // two sweeps, O(N); stays definite for symmetric problems
  composite,        // dense matrix in O(N^2), Cholesky or LU in O(N^3)
  sparse,           // states, unknowns and wrenches in one system, KLU
  recursive_plain,  // two sweeps by the textbook update, which loses digits (a pitfall)
  elastic_local,    // our reconstruction of a recursion that leaves the friction and
                    // stiffness of distal segments out of the elimination
};

/// Solves S x = b for one TreeTangent. factor() and solve() do not allocate after the
/// first call.
template <class Shape>
class TreeSolver {
 public:
  using In = std::span<const typename Shape::Real>;  // read-only array of scalars
  using Out = std::span<typename Shape::Real>;       // array of scalars to write

  virtual ~TreeSolver() = default;
  /// Factors S; `retry` if a pivot is not usable. The tangent must outlive the solves.
  virtual Status factor(const TreeTangent<Shape>& tangent) noexcept = 0;
  /// Solves S x = b with the last factors. b and x may be the same.
  virtual Status solve(In b, Out x) noexcept = 0;
  /// Solves S^T x = b with the last factors. Returns false where the solver does not;
  /// `recursive` does.
  virtual bool solve_transposed(In /*b*/, Out /*x*/) noexcept { return false; }

  /// Loads on the tip of a segment (-1: on the root).
  struct Load {
    int segment;  // index of the segment; -1: the root
    /// Wrenches P_i of respond().
    Eigen::Matrix<typename Shape::Real, Shape::wrench, 3> columns;
  };
  /// Computes the response of tips of a chain to loads on these tips, in ascending order
  /// of segments. The columns P_i of a load are wrenches, which cause the states s_ji P_i
  /// of tip j. Writes the blocks P_j^T s_ji P_i by rows: for the first i all j, then for
  /// the second. Returns false where the solver has no such response; solve() then
  /// serves.
  virtual bool respond(std::span<const Load>, Out /*blocks*/) noexcept { return false; }
};

/// Makes the solver for tangents with the parents and the root of `structure`. The last
/// two methods exist for symmetric shapes; exact Jacobians get `recursive`.
template <class Shape>
std::unique_ptr<TreeSolver<Shape>> make_tree_solver(TreeMethod method,
                                                    const TreeTangent<Shape>& structure);

}  // namespace tress::models
