#pragma once

#include <memory>
#include <vector>

#include "contract/forms/constraint_form.h"
#include "contract/forms/material_points.h"
#include "contract/forms/point_accelerations.h"
#include "contract/system.h"
#include "models/motion/root_motion.h"

namespace tress::models {

/// A ball joint between a material point of a strand and a path in space.
struct Support {
  int point = 0;    // of MaterialPoints
  RootMotion path;  // place of the joint over time; its frame is not used
  /// Directions in which the point is held, orthonormal.
  std::vector<Vec> axes{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
};

/// Constraints of supports, after those that the strand has of its own:
///
///     g = e . (x_i(t, q) - p(t)),   G^T = J_i^T e,
///
/// a row for each support and each of its axes e, with x_i the material point and p the
/// path. Points that are means of coordinates (MaterialPoints::mean) have a constant G.
/// Other points take G from pull_back() and g'' - G a from PointAccelerations.
///
/// Second derivatives d(G^T lambda)/dq are central differences of pull_back() (relative
/// error 1e-10): no model has them in closed form at a point. They enter the matrix of
/// Newton's method only, not the equations.
class SupportRows final : public ConstraintForm {
 public:
  /// Throws InputError naming the support if the model cannot hold its point. `strand`
  /// must outlive it.
  SupportRows(System& strand, std::vector<Support> supports);

  /// Returns the supports.
  const std::vector<Support>& supports() const { return supports_; }
  /// Returns the number of the strand's own constraints, which come first.
  int own() const { return own_rows_; }
  /// Returns the number of all constraints.
  int rows() const { return pattern_.cols; }

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
  template <class Read>
  void fill(const std::vector<double>& x, const Read& place, Out rows) const;
  void pull(double t, In q, const Support& support, const Vec& axis, InOut column);
  void multiplied(double t, In q, In lambda, InOut sum);
  double step(In v) const;

  System& strand_;
  MaterialPoints& points_;
  PointAccelerations* accelerations_;
  ConstraintForm* own_;  // null: the strand has no constraints
  int own_rows_ = 0;
  std::size_t own_entries_ = 0;  // of G^T
  std::vector<Support> supports_;
  bool linear_;  // points are means of coordinates
  Pattern pattern_;
  std::vector<double> constant_;  // G^T of the supports, if linear_
  std::vector<double> q_typ_, v_typ_;
  std::vector<double> x_, zero_, shifted_, ahead_, behind_;  // scratch
};

}  // namespace tress::models
