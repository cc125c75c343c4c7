#pragma once

#include <vector>

#include "contract/forms/constraint_form.h"
#include "models/joints/joint_pair.h"
#include "models/supports/supported_system.h"

namespace tress::models {

/// Constraints of joined strands: those of each strand and its supports, strand after
/// strand, then the rows of the joints (JointPair). Rows of joints have entries at all
/// coordinates of their strands.
///
/// Derivatives of G by the state are central differences, of G along a motion or of
/// G^T lambda. They enter matrices of Newton's method only.
class JoinedRows final : public ConstraintForm {
 public:
  /// A strand and its first coordinate.
  struct Member {
    SupportedSystem* strand;  // with its supports
    std::size_t first;        // coordinate among those of all strands
  };
  /// Members and joints must outlive it.
  JoinedRows(std::vector<Member> members, std::vector<JointPair>& joints);

  /// Returns the number of all constraints.
  int rows() const { return pattern_.cols; }
  /// Returns true if a constraint of a joint is a rotation (rad), not a place (m).
  bool turns(int row) const;
  /// Returns the first constraint of the joints.
  std::size_t first_of_joints() const { return first_joint_; }
  /// Returns the multipliers of a strand and its supports.
  In of_strand(In lambda, std::size_t k) const;
  /// Returns the multipliers of a joint.
  In of_joint(In lambda, std::size_t k) const;
  /// Returns the length of the longest strand, m.
  double length() const { return length_; }

  const Pattern& pattern() const override { return pattern_; }
  void scale(Out g_typ) const override;
  Status value(double t, In q, Out g) noexcept override;
  Status gradient(double t, In q, Out gt) noexcept override;
  Status rate(double t, In q, In v, Out g_dot) noexcept override;
  Status bias(double t, In q, In v, Out b) noexcept override;
  Status rate_gradient(double t, In q, In v, Out values) noexcept override;
  /// s: the full matrix of all strands.
  Status add_curvature(double t, In q, In lambda, double factor,
                       InOut s) noexcept override;

 private:
  /// Numbers of a strand among those of all: coordinates, rows and entries of G^T.
  struct Place {
    std::size_t first, size, row, rows, entry, entries;
  };
  struct JointRow {
    std::size_t row, entry;  // first ones
  };
  template <class Act>
  Status each_strand(const Act& act) noexcept;
  template <class Act>
  void each_joint(Out g, const Act& act) noexcept;
  void add_gradient(double t, In q, double factor, InOut entries) noexcept;

  std::vector<Member> members_;
  std::vector<JointPair>& joints_;
  std::vector<Place> places_;         // of each strand
  std::vector<JointRow> joint_rows_;  // of each joint, and the end
  std::size_t first_joint_ = 0;
  double length_ = 0;
  Pattern pattern_;
  std::vector<double> q_typ_, v_typ_;
  std::vector<double> shifted_, column_, ahead_, behind_, gt_;  // scratch
};

}  // namespace tress::models
