#pragma once

#include "integrators/sundials/first_order.h"

namespace tress::integrators {

/// FirstOrder::solve as the nonlinear solver of CVODE or ARKODE, which leave the
/// iteration to it.
class ImplicitAdapter {
 public:
  /// Solves `equations`, which must outlive it.
  ImplicitAdapter(const SundialsContext& context, FirstOrder& equations);

  /// Becomes the nonlinear solver of this CVODE.
  void attach(const CvodeMemory& memory);
  /// Becomes the nonlinear solver of this ARKStep.
  void attach(const ArkstepMemory& memory);

 private:
  /// Equation that SUNDIALS passes to be solved: y = predicted + correction = known +
  /// gamma f(t, y).
  struct Equation {
    double t = 0, gamma = 0;
    In predicted;
  };
  /// Fills known_ as well. 0, or the library's error code.
  using Read = int (*)(void* memory, Equation& equation, Out known);

  static int read_cvode(void* memory, Equation& equation, Out known) noexcept;
  static int read_arkstep(void* memory, Equation& equation, Out known) noexcept;
  static int solve(SUNNonlinearSolver solver, N_Vector, N_Vector correction, N_Vector,
                   sunrealtype, sunbooleantype, void* memory) noexcept;

  struct Free {
    void operator()(SUNNonlinearSolver solver) const { SUNNonlinSolFreeEmpty(solver); }
  };
  FirstOrder& equations_;
  std::unique_ptr<std::remove_pointer_t<SUNNonlinearSolver>, Free> solver_;
  Read read_ = nullptr;
  std::vector<double> known_, y_;
};

}  // namespace tress::integrators
