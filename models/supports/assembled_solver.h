#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "contract/forms/sparse_form.h"
#include "linear/linear_solver.h"

namespace tress::models {

/// System::linearize and solve of a system that has S(w) as a SparseForm.
class AssembledSolver {
 public:
  /// Takes S from `form`, which must outlive it.
  explicit AssembledSolver(SparseForm& form)
      : form_(form),
        solver_(make_linear_solver(LinearKind::automatic, form.pattern())),
        values_(static_cast<std::size_t>(form.pattern().nonzeros())) {}

  /// Assembles and factors S(w).
  Status linearize(double t, In q, In v, In a, Weights w) noexcept {
    const Status s = form_.values(t, q, v, a, w, values_);
    return s == Status::ok ? solver_->factor(values_) : s;
  }
  /// Solves S(w) x = b.
  Status solve(In b, Out x) noexcept {
    if (x.data() != b.data()) std::ranges::copy(b, x.begin());
    return solver_->solve(x);
  }

 private:
  SparseForm& form_;
  std::unique_ptr<LinearSolver> solver_;
  std::vector<double> values_;
};

}  // namespace tress::models
