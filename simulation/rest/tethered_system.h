#pragma once

#include <vector>

#include "models/supports/supported_system.h"

namespace tress::simulation {

/// A held strand at t = 0 with additional springs c/typical^2 between its coordinates and
/// an origin. They spread a change of shape over the strand, however limp it is.
class TetheredSystem final : public System, private SparseForm {
 public:
  /// Adds springs without stiffness to `held`, which must outlive them.
  explicit TetheredSystem(models::SupportedSystem& held)
      : held_(held), form_(*held.sparse_form()), solver_(*this) {
    const auto n = static_cast<std::size_t>(held.layout().coordinates);
    origin.resize(n);
    typical.resize(n);
    std::vector<double> rates(n);
    held.scale(typical, rates);
    const Pattern& pattern = form_.pattern();
    for (int k = 0; k < pattern.cols; ++k) {
      const auto column = static_cast<std::size_t>(k);
      for (int p = pattern.start[column]; p < pattern.start[column + 1]; ++p) {
        if (pattern.row[static_cast<std::size_t>(p)] == k) diagonal_.push_back(p);
      }
    }
  }

  std::vector<double> origin, typical;  // (n): of the springs; of the coordinates
  double stiffness = 0;                 // c, J

  Layout layout() const override { return held_.layout(); }
  Traits traits() const override { return held_.traits(); }
  void initial_state(Out q, Out v) const override { held_.initial_state(q, v); }
  void scale(Out q_typ, Out v_typ) const override { held_.scale(q_typ, v_typ); }
  Status residual(double t, In q, In v, In a, Out r) noexcept override {
    const Status s = held_.residual(t, q, v, a, r);
    for (std::size_t i = 0; i < q.size(); ++i) {
      r[i] += stiffness * (q[i] - origin[i]) / (typical[i] * typical[i]);
    }
    return s;
  }
  Status linearize(double t, In q, In v, In a, Weights w) noexcept override {
    return solver_.linearize(t, q, v, a, w);
  }
  Status solve(In b, Out x) noexcept override { return solver_.solve(b, x); }
  SparseForm* sparse_form() override { return this; }
  ConstraintForm* constraint_form() override { return held_.constraint_form(); }
  const Pattern& pattern() const override { return form_.pattern(); }
  Status values(double t, In q, In v, In a, Weights w, Out s) noexcept override {
    const Status status = form_.values(t, q, v, a, w, s);
    for (std::size_t i = 0; i < diagonal_.size(); ++i) {
      s[static_cast<std::size_t>(diagonal_[i])] +=
          w.pos * stiffness / (typical[i] * typical[i]);
    }
    return status;
  }

 private:
  models::SupportedSystem& held_;
  SparseForm& form_;
  models::AssembledSolver solver_;
  std::vector<int> diagonal_;  // entries of the pattern
};

}  // namespace tress::simulation
