#pragma once

#include <optional>
#include <vector>

#include "models/supports/supported_system.h"

namespace tress::simulation {

/// A held strand at t = 0 with additional springs c/typical^2 between its coordinates and
/// an origin. They spread a change of shape over the strand, however limp it is.
class TetheredSystem final : public System, public BorderedForm, private SparseForm {
 public:
  /// Adds springs without stiffness to `held`, which must outlive them.
  explicit TetheredSystem(models::SupportedSystem& held)
      : held_(held), form_(held.takes_springs() ? nullptr : held.sparse_form()) {
    const auto n = static_cast<std::size_t>(held.layout().coordinates);
    for (auto* x : {&origin, &typical, &springs_}) x->resize(n);
    std::vector<double> rates(n);
    held.scale(typical, rates);
    if (form_ == nullptr) return;
    const Pattern& pattern = form_->pattern();
    for (int k = 0; k < pattern.cols; ++k) {
      const auto column = static_cast<std::size_t>(k);
      for (int p = pattern.start[column]; p < pattern.start[column + 1]; ++p) {
        if (pattern.row[static_cast<std::size_t>(p)] == k) diagonal_.push_back(p);
      }
    }
    solver_.emplace(static_cast<SparseForm&>(*this));
  }

  std::vector<double> origin, typical;  // (n): of the springs; of the coordinates
  double stiffness = 0;                 // c, J

  Layout layout() const override { return held_.layout(); }
  Traits traits() const override { return held_.traits(); }
  void initial_state(Out q, Out v) const override { held_.initial_state(q, v); }
  void scale(Out q_typ, Out v_typ) const override { held_.scale(q_typ, v_typ); }
  Status residual(double t, In q, In v, In a, Out r) noexcept override {
    const Status s = held_.residual(t, q, v, a, r);
    for (std::size_t i = 0; i < q.size(); ++i) r[i] += spring(i) * (q[i] - origin[i]);
    return s;
  }
  Status linearize(double t, In q, In v, In a, Weights w) noexcept override {
    return solver_ ? solver_->linearize(t, q, v, a, w)
                   : linearize_bordered(t, q, v, a, {}, w);
  }
  Status solve(In b, Out x) noexcept override {
    return solver_ ? solver_->solve(b, x) : held_.solve(b, x);
  }
  SparseForm* sparse_form() override { return solver_ ? this : nullptr; }
  ConstraintForm* constraint_form() override { return held_.constraint_form(); }
  bool bordered() const override { return held_.bordered(); }
  Status linearize_bordered(double t, In q, In v, In a, In lambda,
                            Weights w) noexcept override {
    for (std::size_t i = 0; i < springs_.size(); ++i) springs_[i] = spring(i);
    return held_.linearize_with_springs(t, q, v, a, lambda, w, springs_);
  }

 private:
  double spring(std::size_t i) const { return stiffness / (typical[i] * typical[i]); }
  const Pattern& pattern() const override { return form_->pattern(); }
  Status values(double t, In q, In v, In a, Weights w, Out s) noexcept override {
    const Status status = form_->values(t, q, v, a, w, s);
    for (std::size_t i = 0; i < diagonal_.size(); ++i) {
      s[static_cast<std::size_t>(diagonal_[i])] += w.pos * spring(i);
    }
    return status;
  }

  models::SupportedSystem& held_;
  SparseForm* form_;  // null: the strand takes springs
  std::optional<models::AssembledSolver> solver_;
  std::vector<int> diagonal_;  // entries of the pattern
  std::vector<double> springs_;
};

}  // namespace tress::simulation
