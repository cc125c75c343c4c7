#pragma once

#include "contract/basics.h"
#include "contract/pattern.h"

namespace tress {

/// Position constraints g(t, q) = 0 in the units of the model (lengths in m, angles in
/// rad).
class ConstraintForm {
 public:
  virtual ~ConstraintForm() = default;

  /// Pattern of G^T (n x m): column k holds the gradient of constraint k. Fixed for life.
  virtual const Pattern& pattern() const = 0;
  /// Writes typical sizes of the constraints, (m).
  virtual void scale(Out g_typ) const = 0;
  /// Evaluates g(t, q), (m).
  virtual Status value(double t, In q, Out g) noexcept = 0;
  /// Evaluates G^T = (dg/dq)^T on pattern().
  virtual Status gradient(double t, In q, Out gt) noexcept = 0;
  /// Evaluates g' = G v + g_t, (m).
  virtual Status rate(double t, In q, In v, Out g_dot) noexcept = 0;
  /// Evaluates g'' - G a, (m).
  virtual Status bias(double t, In q, In v, Out b) noexcept = 0;
  /// (d(G v + g_t)/dq)^T on pattern(): the derivative of the rate.
  virtual Status rate_gradient(double t, In q, In v, Out values) noexcept = 0;
  /// s += factor d(G^T lambda)/dq on the pattern of the system's SparseForm.
  virtual Status add_curvature(double t, In q, In lambda, double factor,
                               InOut s) noexcept = 0;
};

}  // namespace tress
