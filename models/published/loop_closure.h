#pragma once

#include <span>
#include <vector>

#include "contract/basics.h"
#include "contract/forms/constraint_form.h"
#include "contract/pattern.h"

namespace tress::models {

/// One link of a planar loop: length * trig(angle) with angle q_i or q_i + q_j.
struct LoopTerm {
  /// Function of the angle: `cosine` or `sine`.
  enum class Trig { cosine, sine };
  int constraint;  // index of the constraint
  double length;   // m, signed
  Trig trig;       // function of the angle
  int i;           // coordinate of the angle
  int j = -1;      // -1: the angle is q_i alone
};

/// Closure of planar linkages, g_k(q) = sum_terms length trig(q_i [+ q_j]) - target_k =
/// 0. Every derivative of a term is the same term rotated by quarter turns, so value,
/// gradient, rate, bias and curvature use one table. The system's tangent must be stored
/// full (n x n, compressed columns). Cost O(terms).
class LoopClosure final : public ConstraintForm {
 public:
  /// Takes the terms and targets (m) of all constraints.
  LoopClosure(int coordinates, std::span<const LoopTerm> terms,
              std::span<const double> targets, double typical_length);

  /// Returns the number of constraints.
  int count() const { return static_cast<int>(targets_.size()); }
  const Pattern& pattern() const override { return pattern_; }
  void scale(Out g_typ) const override;
  Status value(double t, In q, Out g) noexcept override;
  Status gradient(double t, In q, Out gt) noexcept override;
  Status rate(double t, In q, In v, Out g_dot) noexcept override;
  Status bias(double t, In q, In v, Out b) noexcept override;
  Status rate_gradient(double t, In q, In v, Out values) noexcept override;
  Status add_curvature(double t, In q, In lambda, double factor,
                       InOut s) noexcept override;

 private:
  struct Slots {
    int i;
    int j;  // -1 when the term has one angle
  };

  int coordinates_;
  std::vector<LoopTerm> terms_;
  std::vector<double> targets_;  // (m) m
  std::vector<Slots> slots_;     // per term, indices into the values on pattern_
  double typical_length_;
  Pattern pattern_;
};

}  // namespace tress::models
