#include "integrators/sundials/linear_adapter.h"

#include <algorithm>

namespace tress::integrators {
namespace {

NewtonMatrix& newton(SUNMatrix matrix) {
  return *static_cast<NewtonMatrix*>(matrix->content);
}

int factor(double t, N_Vector y, N_Vector y_dot, double coefficient,
           SUNMatrix matrix) noexcept {
  return sundials_code(newton(matrix).factor(t, entries(y), entries(y_dot), coefficient));
}

int ida_jacobian(sunrealtype t, sunrealtype cj, N_Vector y, N_Vector y_dot, N_Vector,
                 SUNMatrix matrix, void*, N_Vector, N_Vector, N_Vector) noexcept {
  return factor(t, y, y_dot, cj, matrix);
}

int solve(SUNLinearSolver, SUNMatrix matrix, N_Vector x, N_Vector b,
          sunrealtype) noexcept {
  const In right = entries(b);
  const Out solution = entries(x);
  std::copy(right.begin(), right.end(), solution.begin());
  return linear_solver_code(newton(matrix).solve(solution));
}

}  // namespace

LinearAdapter::LinearAdapter(const SundialsContext& context, NewtonMatrix& newton_matrix)
    : matrix_(require(SUNMatNewEmpty(context.handle()), "SUNMatNewEmpty")),
      solver_(require(SUNLinSolNewEmpty(context.handle()), "SUNLinSolNewEmpty")) {
  matrix_->content = &newton_matrix;
  matrix_->ops->getid = [](SUNMatrix) noexcept { return SUNMATRIX_CUSTOM; };
  matrix_->ops->zero = [](SUNMatrix) noexcept {
    return 0;
  };  // called by IDA before every factor
  solver_->ops->gettype = [](SUNLinearSolver) noexcept { return SUNLINEARSOLVER_DIRECT; };
  solver_->ops->getid = [](SUNLinearSolver) noexcept { return SUNLINEARSOLVER_CUSTOM; };
  solver_->ops->initialize = [](SUNLinearSolver) noexcept { return 0; };
  // The callbacks factor, because only they know the time and coefficient.
  solver_->ops->setup = [](SUNLinearSolver, SUNMatrix) noexcept { return 0; };
  solver_->ops->solve = &solve;
}

void LinearAdapter::attach(const IdaMemory& memory) const {
  require(IDASetLinearSolver(memory.get(), solver_.get(), matrix_.get()),
          "IDASetLinearSolver");
  require(IDASetJacFn(memory.get(), &ida_jacobian), "IDASetJacFn");
}

}  // namespace tress::integrators
