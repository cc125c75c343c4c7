#include "integrators/sundials/implicit_adapter.h"

#include <algorithm>

namespace tress::integrators {

ImplicitAdapter::ImplicitAdapter(const SundialsContext& context, FirstOrder& equations)
    : equations_(equations),
      solver_(require(SUNNonlinSolNewEmpty(context.handle()), "SUNNonlinSolNewEmpty")),
      known_(2 * static_cast<std::size_t>(equations.rates().n())),
      y_(known_) {
  solver_->content = this;
  // Of the type that needs no linear solver beside it.
  solver_->ops->gettype = [](SUNNonlinearSolver) noexcept {
    return SUNNONLINEARSOLVER_FIXEDPOINT;
  };
  solver_->ops->setsysfn = [](SUNNonlinearSolver, SUNNonlinSolSysFn) noexcept {
    return SUN_NLS_SUCCESS;
  };
  solver_->ops->solve = &solve;
}

void ImplicitAdapter::attach(const CvodeMemory& memory) {
  read_ = &read_cvode;
  require(CVodeSetNonlinearSolver(memory.get(), solver_.get()),
          "CVodeSetNonlinearSolver");
}

void ImplicitAdapter::attach(const ArkstepMemory& memory) {
  read_ = &read_arkstep;
  require(ARKStepSetNonlinearSolver(memory.get(), solver_.get()),
          "ARKStepSetNonlinearSolver");
  // The stage has its rate; evaluating it again would take a mass solve.
  require(ARKStepSetDeduceImplicitRhs(memory.get(), 1), "ARKStepSetDeduceImplicitRhs");
}

/// rl1 zn1 + correction - gamma f(t, y) = 0.
int ImplicitAdapter::read_cvode(void* memory, Equation& equation, Out known) noexcept {
  N_Vector predicted = nullptr, y = nullptr, f = nullptr, scaled_rate = nullptr;
  sunrealtype share = 0;
  void* user = nullptr;
  const int code =
      CVodeGetNonlinearSystemData(memory, &equation.t, &predicted, &y, &f,
                                  &equation.gamma, &share, &scaled_rate, &user);
  if (code != CV_SUCCESS) return code;
  equation.predicted = entries(predicted);
  const In rate = entries(scaled_rate);
  for (std::size_t i = 0; i < known.size(); ++i) {
    known[i] = equation.predicted[i] - share * rate[i];
  }
  return code;
}

/// correction - data - gamma f(t, y) = 0.
int ImplicitAdapter::read_arkstep(void* memory, Equation& equation, Out known) noexcept {
  N_Vector predicted = nullptr, y = nullptr, f = nullptr, data = nullptr;
  void* user = nullptr;
  const int code = ARKStepGetNonlinearSystemData(memory, &equation.t, &predicted, &y, &f,
                                                 &equation.gamma, &data, &user);
  if (code != ARK_SUCCESS) return code;
  equation.predicted = entries(predicted);
  const In known_part = entries(data);
  for (std::size_t i = 0; i < known.size(); ++i) {
    known[i] = equation.predicted[i] + known_part[i];
  }
  return code;
}

int ImplicitAdapter::solve(SUNNonlinearSolver solver, N_Vector, N_Vector correction,
                           N_Vector, sunrealtype, sunbooleantype, void* memory) noexcept {
  auto& self = *static_cast<ImplicitAdapter*>(solver->content);
  Equation equation;
  if (const int code = self.read_(memory, equation, self.known_); code != 0) return code;
  const Out out = entries(correction);
  for (std::size_t i = 0; i < out.size(); ++i) {
    self.y_[i] = equation.predicted[i] + out[i];
  }
  const Status s =
      self.equations_.solve(equation.t, self.known_, equation.gamma, self.y_);
  if (s == Status::fatal) return sundials_code(s);
  if (s != Status::ok) return SUN_NLS_CONV_RECVR;
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = self.y_[i] - equation.predicted[i];
  }
  return SUN_NLS_SUCCESS;
}

}  // namespace tress::integrators
