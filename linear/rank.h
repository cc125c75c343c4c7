#pragma once

#include <memory>

#include "contract/basics.h"
#include "contract/pattern.h"

namespace tress {

/// Combinations of constraint gradients that vanish: the null space N of G^T (n x m). A
/// rank-revealing QR of the scaled matrix R G^T E, whose columns have about unit length,
/// gives
///
///     R G^T E P = Q [R11 R12; 0 0],      N = E P [-R11^-1 R12; I].
///
/// A column counts as dependent when its component outside the span of the others is
/// shorter than `dependence`. N stays sparse; projections solve with N^T N. Allocates.
class NullSpace {
 public:
  /// `gt`: values on `pattern`; `rows` (n) and `columns` (m): the scales R and E.
  NullSpace(const Pattern& pattern, In gt, In rows, In columns);
  ~NullSpace();

  /// Returns the number of dependent constraints.
  int dimension() const;
  /// y -= N (N^T N)^-1 N^T y
  void project_out(InOut y) const;

  /// Length, relative to the scaled column, below which a column counts as dependent.
  static constexpr double dependence = 1e-8;

 private:
  struct Basis;
  std::unique_ptr<Basis> basis_;
};

}  // namespace tress
