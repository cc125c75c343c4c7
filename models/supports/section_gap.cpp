#include "models/supports/section_gap.h"

#include "math/quaternion.h"

namespace tress::models {
namespace {

/// A numerator and a divisor, each with two derivatives.
struct Quotient {
  Vec n, dn, ddn;
  double d, dd, ddd;

  Vec value() const { return (1 / d) * n; }
  Vec rate() const { return (1 / d) * (dn - dd * value()); }
  Vec acceleration() const { return (1 / d) * (ddn - (2 * dd) * rate() - ddd * value()); }
};

}  // namespace

SectionGap::SectionGap(Sections::Turning turning, const RootPose& wall,
                       const SectionMotion& section)
    : turning_(turning), wall_(wall.frame) {
  const Frame& f = section.frame;
  const Vec relative = section.omega - wall.omega;
  const Vec w = wall_.back(relative),
            dw = wall_.back(section.alpha - wall.alpha - cross(wall.omega, relative));
  Quotient c{};
  if (turning == Sections::Turning::frame) {
    const Quaternion q = nearer(
        {1, {}}, quaternion_of({wall_.back(f.e0), wall_.back(f.e1), wall_.back(f.e2)}));
    scalar_ = q.w;
    vector_ = q.v;
    const double ds = -0.5 * dot(w, q.v);
    const Vec dv = 0.5 * (q.w * w + cross(w, q.v));
    c = {4.0 * q.v, 4.0 * dv, 2.0 * (ds * w + q.w * dw + cross(dw, q.v) + cross(w, dv)),
         1 + q.w,   ds,       -0.5 * (dot(dw, q.v) + dot(w, dv))};
  } else {
    const Vec t = wall_.back(f.e0), dt = cross(w, t), ddt = cross(dw, t) + cross(w, dt);
    vector_ = t;
    const auto across = [](const Vec& x) { return Vec{0, -2 * x.z, 2 * x.y}; };
    c = {across(t), across(dt), across(ddt), 1 + t.x, dt.x, ddt.x};
  }
  divisor_ = c.d;
  value = c.value();
  rate = c.rate();
  acceleration = c.acceleration();
}

Vec SectionGap::moment(const Vec& stress) const {
  const double by = 2 / divisor_;
  if (turning_ == Sections::Turning::frame) {
    return wall_ * (by * (scalar_ * stress + cross(vector_, stress)) +
                    (by / divisor_ * dot(stress, vector_)) * vector_);
  }
  const Vec& t = vector_;
  const Vec slope =
      by * Vec{(stress.y * t.z - stress.z * t.y) / divisor_, stress.z, -stress.y};
  return wall_ * cross(t, slope);
}

}  // namespace tress::models
