#include "models/reduced/tree_solver.h"

#include "models/reduced/composite_solver.h"
#include "models/reduced/recursive_solver.h"
#include "models/reduced/shapes.h"
#include "models/reduced/sparse_solver.h"

namespace tress {

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
    if (method == TreeMethod::less_implicit) {
      return std::make_unique<RecursiveSolver<Shape, TreeMethod::less_implicit>>(
          structure);
    }
  }
  return std::make_unique<RecursiveSolver<Shape>>(structure);
}

#define TRESS_INSTANTIATE(Shape)                                       \
  template std::unique_ptr<TreeSolver<Shape>> make_tree_solver<Shape>( \
      TreeMethod, const TreeTangent<Shape>&)
TRESS_INSTANTIATE(MassShape<3>);
TRESS_INSTANTIATE(MassShape<2>);
TRESS_INSTANTIATE(MassShape<1>);
TRESS_INSTANTIATE(ExactShape<3>);
TRESS_INSTANTIATE(ExactShape<2>);
TRESS_INSTANTIATE(ExactShape<1>);
#undef TRESS_INSTANTIATE

}  // namespace tress
