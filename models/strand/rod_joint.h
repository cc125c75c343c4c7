#pragma once

#include <vector>

#include "contract/layers.h"
#include "models/strand/strand.h"

namespace tress::models {

/// Bending and twisting between two neighbouring segments of a discrete rod, a length l
/// apart, in integrated strains (twist, curvature about e1, curvature about e2):
///
///     E = sum_k stiffness_k (kappa_k - rest_k)^2/2,    stiffness = diag(GJ, EI1, EI2)/l.
struct RodJoint {
  Vec rest;       // rad
  Vec stiffness;  // moment per strain, N m
  Vec friction;   // moment per rate of strain, N m s
};

/// The joint that represents half of each neighbour; for a clamp (`before` null), half of
/// the first segment.
inline RodJoint rod_joint(const Strand& strand, const Segment* before,
                          const Segment& after, const Vec& rest) {
  const double l = (after.length + (before != nullptr ? before->length : 0)) / 2;
  Vec weighted = after.length / 2 * stiffness(strand, after);
  double friction = strand.material_of(after).internal_friction / l;
  if (before != nullptr) {
    const double share = before->length / (2 * l);
    weighted = weighted + before->length / 2 * stiffness(strand, *before);
    friction += share * (strand.material_of(*before).internal_friction / l - friction);
  }
  return {rest, 1 / (l * l) * weighted, {friction, friction, friction}};
}

/// A member of every joint, three numbers each.
inline std::vector<double> of_joints(const std::vector<RodJoint>& joints,
                                     Vec RodJoint::*member) {
  std::vector<double> all(3 * joints.size());
  for (std::size_t j = 0; j < joints.size(); ++j) store3(joints[j].*member, &all[3 * j]);
  return all;
}

}  // namespace tress::models
