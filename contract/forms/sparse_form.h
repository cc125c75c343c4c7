#pragma once

#include "contract/basics.h"
#include "contract/pattern.h"

namespace tress {

/// S(w) as a sparse matrix, for direct solvers. Required for systems with constraints.
class SparseForm {
 public:
  virtual ~SparseForm() = default;
  virtual const Pattern& pattern() const = 0;  // (n x n), fixed for the system's life
  /// Evaluates S(w) at a state, the entries of pattern() in its order.
  virtual Status values(double t, In q, In v, In a, Weights w, Out s) noexcept = 0;
};

}  // namespace tress
