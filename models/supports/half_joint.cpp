#include "models/supports/half_joint.h"

#include <algorithm>

#include "models/supports/vec_parts.h"

namespace tress::models {

/// Components that are held; others are 0.
Vec HalfJoint::held(const Vec& c) const {
  double all[3] = {};
  const double from[3] = {c.x, c.y, c.z};
  for (const int k : section_.components()) all[k] = from[k];
  return load3(all);
}

Vec HalfJoint::stress(const SectionGap& gap) const {
  return held(entrywise(joint_.stiffness, gap.value - lead_) +
              entrywise(joint_.friction, gap.rate));
}

Vec HalfJoint::rotation(double t, In q) {
  return held(section_.gap(t, q).value - section_.seen(begin_).value);
}

void HalfJoint::add_force(double t, In q, In v, InOut r) {
  zero_.resize(q.size());
  const SectionGap gap = section_.gap(t, q, v, zero_);
  section_.pull(t, q, gap, stress(gap), r);
}

void HalfJoint::add_tangent(double t, In q, In v, Weights w, InOut s) {
  if (w.pos != 0) {
    section_.add_derivative(
        t, q, true, w.pos, [&](In x, InOut b) { add_force(t, x, v, b); }, s);
  }
  if (w.vel != 0 && norm(joint_.friction) > 0) {
    zero_.resize(q.size());
    const auto friction = [&](In x, InOut b) {
      const SectionGap gap = section_.gap(t, q, x, zero_);
      section_.pull(t, q, gap, held(entrywise(joint_.friction, gap.rate)), b);
    };
    section_.add_derivative(t, v, false, w.vel, friction, s);
  }
}

double HalfJoint::energy(double t, In q) {
  const Vec c = held(section_.gap(t, q).value - lead_);
  return dot(joint_.stiffness, entrywise(c, c)) / 2;
}

double HalfJoint::energy_rate(double t, In q, In v) {
  zero_.resize(q.size());
  const SectionGap gap = section_.gap(t, q, v, zero_);
  return dot(held(entrywise(joint_.stiffness, gap.value - lead_)), gap.rate);
}

SectionLoad HalfJoint::load(double t, In q, In v) {
  zero_.resize(q.size());
  const Vec opposed = stress(section_.gap(t, q, v, zero_));
  return section_.load(t, q, v, zero_, -1.0 * opposed, -1.0 * held(joint_.stiffness),
                       -1.0 * held(joint_.friction));
}

}  // namespace tress::models
