#pragma once

#include "integrators/sundials/sundials.h"

namespace tress::integrators {

/// The Newton matrix of IDA, as it uses it: rebuilt at a state when its rules require it,
/// and used for solves until then.
class NewtonMatrix {
 public:
  virtual ~NewtonMatrix() = default;

  /// dF/dy + coefficient dF/dy'.
  virtual Status factor(double t, In y, In y_dot, double coefficient) noexcept = 0;

  /// Overwrites b with the solution.
  virtual Status solve(InOut b) noexcept = 0;
};

/// An opaque SUNMatrix with a direct SUNLinearSolver around a NewtonMatrix. It is not of
/// the matrix-embedded type, which would switch off the lazy refactorisation of IDA and
/// the rescaling of corrections when cj has changed since.
class LinearAdapter {
 public:
  /// Solves with `newton`, which must outlive it.
  LinearAdapter(const SundialsContext& context, NewtonMatrix& newton);

  /// Becomes the linear solver of this IDA.
  void attach(const IdaMemory& memory) const;

 private:
  struct FreeMatrix {
    void operator()(SUNMatrix matrix) const { SUNMatFreeEmpty(matrix); }
  };
  struct FreeSolver {
    void operator()(SUNLinearSolver solver) const { SUNLinSolFreeEmpty(solver); }
  };
  std::unique_ptr<std::remove_pointer_t<SUNMatrix>, FreeMatrix> matrix_;
  std::unique_ptr<std::remove_pointer_t<SUNLinearSolver>, FreeSolver> solver_;
};

}  // namespace tress::integrators
