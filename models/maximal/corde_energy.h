#pragma once

#include "models/math/quaternion.h"
#include "models/maximal/rod_joint.h"

namespace tress {

/// What one edge of corde.h is made of.
struct CordeEdge {
  double length;            // l at rest, m
  double stretch;           // EA/l, N/m
  double stretch_friction;  // force per rate of |e|, N s/m
  double coupling, norm;    // l kappa and l nu, J
};

/// Stretching, and what couples the quaternion to the edge and keeps its norm:
/// EA l (|e|/l - 1)^2/2 + (l kappa |e/|e| - t(q)|^2 + l nu (|q|^2 - 1)^2)/2.
template <class T>
T edge_energy(const CordeEdge& edge, const Vec3<T>& e, const QuaternionOf<T>& q) {
  using std::sqrt;
  const T length = sqrt(dot(e, e));
  const T longer = length - T(edge.length);
  const Vec3<T> apart = (T(1) / length) * e - first_axis(q);
  const T swollen = dot(q, q) - T(1);
  return T(edge.stretch / 2) * longer * longer +
         T(edge.coupling / 2) * dot(apart, apart) + T(edge.norm / 2) * swollen * swollen;
}

/// Bending and twisting between neighbouring quaternions.
template <class T>
T joint_energy(const RodJoint& joint, const QuaternionOf<T>& before,
               const QuaternionOf<T>& behind) {
  const Vec3<T> bent = turn_between(before, behind) - Vec3<T>(joint.rest);
  return T(joint.stiffness.x / 2) * bent.x * bent.x +
         T(joint.stiffness.y / 2) * bent.y * bent.y +
         T(joint.stiffness.z / 2) * bent.z * bent.z;
}

}  // namespace tress
