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

/// Returns the modulus of two pieces in series, of which the first is this share; exactly
/// that of both if they are equal.
inline double in_series(double share, double first, double second) {
  return first == second ? first : 1 / (share / first + (1 - share) / second);
}

/// Returns the joint that represents half of each neighbour; for a clamp (`before` null),
/// half of the first segment. The halves bear the same moment, in series: of second order
/// also where the stiffness jumps.
inline RodJoint rod_joint(const Strand& strand, const Segment* before,
                          const Segment& after, const Vec& rest) {
  const Segment& other = before != nullptr ? *before : after;
  const double first = before != nullptr ? before->length / 2 : 0,
               second = after.length / 2, l = first + second, share = first / l;
  const Vec a = stiffness(strand, other), b = stiffness(strand, after);
  const Vec mean{in_series(share, a.x, b.x), in_series(share, a.y, b.y),
                 in_series(share, a.z, b.z)};
  const double friction = in_series(share, strand.material_of(other).internal_friction,
                                    strand.material_of(after).internal_friction) /
                          l;
  return {
      rest, 1 / (l * l) * (second * mean + first * mean), {friction, friction, friction}};
}

/// A member of every joint, three numbers each.
inline std::vector<double> of_joints(const std::vector<RodJoint>& joints,
                                     Vec RodJoint::*member) {
  std::vector<double> all(3 * joints.size());
  for (std::size_t j = 0; j < joints.size(); ++j) store3(joints[j].*member, &all[3 * j]);
  return all;
}

}  // namespace tress::models
