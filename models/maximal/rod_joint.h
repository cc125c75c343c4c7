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
inline RodJoint rod_joint(const Material& material, const Segment* before,
                          const Segment& after, const Vec& rest) {
  const double l = (after.length + (before != nullptr ? before->length : 0)) / 2;
  Vec weighted = after.length / 2 * stiffness(material, after.section);
  if (before != nullptr) {
    weighted = weighted + before->length / 2 * stiffness(material, before->section);
  }
  const double friction = material.internal_friction / l;
  return {rest, 1 / (l * l) * weighted, {friction, friction, friction}};
}

/// A member of every joint, three numbers each.
inline std::vector<double> of_joints(const std::vector<RodJoint>& joints,
                                     Vec RodJoint::*member) {
  std::vector<double> all(3 * joints.size());
  for (std::size_t j = 0; j < joints.size(); ++j) store3(joints[j].*member, &all[3 * j]);
  return all;
}

/// Converts h over the edge between two nodes and `others` more coordinates to a matrix
/// over the two nodes and the others.
template <int others>
void to_nodes(const double (&h)[3 + others][3 + others],
              double (&m)[6 + others][6 + others]) {
  const auto of = [](int i) { return i < 3 ? i : i - 3; };
  const auto sign = [](int i) { return i < 3 ? -1.0 : 1.0; };
  for (int i = 0; i < 6 + others; ++i) {
    for (int j = 0; j < 6 + others; ++j) m[i][j] = sign(i) * sign(j) * h[of(i)][of(j)];
  }
}

}  // namespace tress::models
