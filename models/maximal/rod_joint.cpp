#include "models/maximal/rod_joint.h"

namespace tress::models {

RodJoint rod_joint(const Material& material, const Segment* before, const Segment& after,
                   const Vec& rest) {
  const double l = (after.length + (before != nullptr ? before->length : 0)) / 2;
  Vec weighted = after.length / 2 * stiffness(material, after.section);
  if (before != nullptr) {
    weighted = weighted + before->length / 2 * stiffness(material, before->section);
  }
  const double friction = material.internal_friction / l;
  return {rest, 1 / (l * l) * weighted, {friction, friction, friction}};
}

}  // namespace tress::models
