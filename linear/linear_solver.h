#pragma once

#include <memory>
#include <string_view>

#include "contract/basics.h"
#include "contract/linear_kind.h"
#include "contract/pattern.h"

namespace tress {

/// Direct solver of A x = b for a fixed pattern; serves our Newton methods and SUNDIALS.
/// Nothing allocates after the first factor() unless pivoting has to be redone.
class LinearSolver {
 public:
  virtual ~LinearSolver() = default;
  /// Returns the solver's name, as LinearKind and Stats have it.
  virtual std::string_view name() const = 0;
  /// `retry` when the matrix is singular to working precision or not finite.
  virtual Status factor(In values) noexcept = 0;
  /// Solves A x = b with the last factors; b becomes x.
  virtual Status solve(InOut b) noexcept = 0;
  /// Cheap estimate of the condition number from the last factorisation.
  virtual double condition() const noexcept = 0;
};

/// `automatic`: dense up to 16 unknowns, banded where a reverse Cuthill-McKee ordering
/// leaves a narrow band, KLU otherwise.
std::unique_ptr<LinearSolver> make_linear_solver(LinearKind kind, const Pattern& pattern);

/// Creates a solver for matrices that are usually symmetric positive definite: a band is
/// eliminated without pivoting where possible (DefiniteBand).
std::unique_ptr<LinearSolver> make_definite_solver(LinearKind kind,
                                                   const Pattern& pattern);

}  // namespace tress
