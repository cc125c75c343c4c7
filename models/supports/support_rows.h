#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "contract/forms/constraint_form.h"
#include "contract/forms/material_points.h"
#include "contract/forms/point_accelerations.h"
#include "contract/system.h"
#include "models/supports/held_section.h"
#include "models/supports/support.h"

namespace tress::models {

/// Constraints of supports, after those that the strand has of its own:
///
///     g = e . (x_i(t, q) - p(t)),   G^T = J_i^T e,
///     g = c_k(t, q),                G^T = J_c^T e_k,
///
/// a row for each support and each of its axes e, with x_i the material point and p the
/// path. Then follows a row for each held component of the rotation c of the section
/// (SectionGap), unless a half edge lies before it (HalfJoint). Springs of compliant
/// supports take the place of rows (AddedForces). Points that are means of
/// coordinates (MaterialPoints::mean) have a constant G. Other points take G from
/// pull_back() and g'' - G a from PointAccelerations. Rotations take both from Sections.
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
  int own() const { return static_cast<int>(own_rows_); }
  /// Returns the number of all constraints.
  int rows() const { return pattern_.cols; }
  /// Returns the length of the strand, m.
  double length() const { return length_; }
  /// Returns true if a constraint is a rotation (rad), not a place (m).
  bool turns(int row) const { return turns_[static_cast<std::size_t>(row)]; }
  /// Returns the force and the moment of support i on the strand, for all multipliers;
  /// without those of springs and joints.
  SectionLoad load(double t, In q, In lambda, std::size_t i);

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
  /// Row of a support among the constraints: held[i] owns rows from first[i] on.
  struct Held {
    std::size_t first = 0;                 // its first row
    std::optional<HeldSection> section{};  // with rows
  };

  void add_row(const std::vector<int>& coordinates, bool turns);
  void add_place(const Support& support, std::size_t i, In q, Out column);
  template <class Read, class Turn>
  void fill(const Read& place, const Turn& turn, Out rows);
  void pull(double t, In q, const Support& support, const Vec& force, InOut sum) {
    const double f[] = {force.x, force.y, force.z};
    static_cast<void>(points_.pull_back(t, q, {&support.point, 1}, f, sum));
  }
  void add_gradient(double t, In q, double factor, InOut entries);
  void multiplied(double t, In q, In lambda, InOut sum);
  Vec force(std::size_t i, In lambda) const;
  Vec stress(std::size_t i, In lambda) const;
  double step(double t, In q, In v);

  System& strand_;
  MaterialPoints& points_;
  PointAccelerations* accelerations_;
  ConstraintForm* own_;                         // null: the strand has no constraints
  std::size_t own_rows_ = 0, own_entries_ = 0;  // of G^T
  std::vector<Support> supports_;
  std::vector<Held> held_;  // of each support
  bool linear_;             // points are means of coordinates
  double length_ = 0;
  Pattern pattern_;
  std::vector<bool> turns_;       // of each row
  std::vector<double> constant_;  // entries of the places in G^T, 0 in other rows
  std::vector<double> q_typ_, v_typ_;
  std::vector<double> x_, zero_, shifted_, ahead_, behind_, column_;  // scratch
};

}  // namespace tress::models
