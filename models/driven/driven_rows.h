#pragma once

#include <vector>

#include "contract/forms/constraint_form.h"
#include "contract/system.h"

namespace tress::models {

/// The constraints of a strand as those of the strand with turning bodies, whose angles
/// come after the strand's coordinates: rows of G without entries at the angles.
class DrivenRows final : public ConstraintForm {
 public:
  /// `coordinates`: with the angles. `strand` must outlive it.
  DrivenRows(System& strand, std::size_t coordinates);

  const Pattern& pattern() const override { return pattern_; }
  void scale(Out g_typ) const override { rows_.scale(g_typ); }
  Status value(double t, In q, Out g) noexcept override {
    return rows_.value(t, of_strand(q), g);
  }
  Status gradient(double t, In q, Out gt) noexcept override {
    return rows_.gradient(t, of_strand(q), gt);
  }
  Status rate(double t, In q, In v, Out g_dot) noexcept override {
    return rows_.rate(t, of_strand(q), of_strand(v), g_dot);
  }
  Status bias(double t, In q, In v, Out b) noexcept override {
    return rows_.bias(t, of_strand(q), of_strand(v), b);
  }
  Status rate_gradient(double t, In q, In v, Out values) noexcept override {
    return rows_.rate_gradient(t, of_strand(q), of_strand(v), values);
  }
  /// s: the full matrix of strand and bodies.
  Status add_curvature(double t, In q, In lambda, double factor,
                       InOut s) noexcept override;

 private:
  In of_strand(In all) const { return all.first(size_); }

  System& strand_;
  ConstraintForm& rows_;
  std::size_t size_;  // coordinates of the strand
  Pattern pattern_;
  std::vector<double> own_;  // on the pattern of the strand's matrix
};

}  // namespace tress::models
