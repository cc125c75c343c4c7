#include "models/reduced/tree/tree_solver.h"

#include "models/reduced/tree/composite_solver.h"
#include "models/reduced/tree/recursive_solver.h"
#include "models/reduced/tree/shapes.h"
#include "models/reduced/tree/sparse_solver.h"

namespace tress::models {

template <class Shape>
std::unique_ptr<TreeSolver<Shape>> make_tree_solver(TreeMethod method,
                                                    const TreeTangent<Shape>& structure) {
  if (method == TreeMethod::composite) {
    return std::make_unique<CompositeSolver<Shape>>(structure);
  }
  if (method == TreeMethod::sparse) {
    return std::make_unique<SparseTreeSolver<Shape>>(structure);
  }
  if constexpr (Shape::symmetric) {
    if (method == TreeMethod::recursive_plain) {
      return std::make_unique<RecursiveSolver<Shape, TreeMethod::recursive_plain>>(
          structure);
    }
    if (method == TreeMethod::elastic_local) {
      return std::make_unique<RecursiveSolver<Shape, TreeMethod::elastic_local>>(
          structure);
    }
  }
  return std::make_unique<RecursiveSolver<Shape>>(structure);
}

template std::unique_ptr<TreeSolver<MassShape<3>>> make_tree_solver(
    TreeMethod, const TreeTangent<MassShape<3>>&);
template std::unique_ptr<TreeSolver<MassShape<2>>> make_tree_solver(
    TreeMethod, const TreeTangent<MassShape<2>>&);
template std::unique_ptr<TreeSolver<MassShape<1>>> make_tree_solver(
    TreeMethod, const TreeTangent<MassShape<1>>&);
template std::unique_ptr<TreeSolver<ExactShape<3>>> make_tree_solver(
    TreeMethod, const TreeTangent<ExactShape<3>>&);
template std::unique_ptr<TreeSolver<ExactShape<2>>> make_tree_solver(
    TreeMethod, const TreeTangent<ExactShape<2>>&);
template std::unique_ptr<TreeSolver<ExactShape<1>>> make_tree_solver(
    TreeMethod, const TreeTangent<ExactShape<1>>&);
// Of clothoids.
template std::unique_ptr<TreeSolver<MassShape<3, double, 2>>> make_tree_solver(
    TreeMethod, const TreeTangent<MassShape<3, double, 2>>&);
template std::unique_ptr<TreeSolver<MassShape<2, double, 2>>> make_tree_solver(
    TreeMethod, const TreeTangent<MassShape<2, double, 2>>&);
template std::unique_ptr<TreeSolver<MassShape<1, double, 2>>> make_tree_solver(
    TreeMethod, const TreeTangent<MassShape<1, double, 2>>&);
template std::unique_ptr<TreeSolver<ExactShape<3, 2>>> make_tree_solver(
    TreeMethod, const TreeTangent<ExactShape<3, 2>>&);
template std::unique_ptr<TreeSolver<ExactShape<2, 2>>> make_tree_solver(
    TreeMethod, const TreeTangent<ExactShape<2, 2>>&);
template std::unique_ptr<TreeSolver<ExactShape<1, 2>>> make_tree_solver(
    TreeMethod, const TreeTangent<ExactShape<1, 2>>&);

}  // namespace tress::models
