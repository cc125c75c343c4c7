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

SectionLoad section_load(Sections::Turning turning, const RootPose& wall,
                         const SectionMotion& section, const Vec& stress,
                         const Vec& stiffness, const Vec& friction) {
  RootPose still;
  still.frame = wall.frame;
  const auto turned = [&](const Vec& omega) {
    return SectionGap(turning, still, {section.frame, omega, {}});
  };
  const auto times = [](const Vec& a, const Vec& b) {
    return Vec{a.x * b.x, a.y * b.y, a.z * b.z};
  };
  const Vec axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const SectionGap along[3] = {turned(axes[0]), turned(axes[1]), turned(axes[2])};
  // b(x, y), with what is known of x and y.
  const auto bilinear = [&](const Vec& x, const SectionGap& of_x, const Vec& y,
                            const SectionGap& of_y) {
    return 0.5 * (turned(x + y).acceleration - of_x.acceleration - of_y.acceleration);
  };
  Vec second[3][3];  // b of two axes
  for (std::size_t i = 0; i < 3; ++i) {
    second[i][i] = along[i].acceleration;
    for (std::size_t j = 0; j < i; ++j) {
      second[i][j] = second[j][i] = bilinear(axes[i], along[i], axes[j], along[j]);
    }
  }
  const SectionGap gap(turning, wall, section);
  SectionLoad load;
  load.moment = gap.moment(stress);
  Vec by_turn[3], by_spin[3];  // columns
  const bool constant = norm(stiffness) + norm(friction) == 0;
  const Vec relative = section.omega - wall.omega;
  const SectionGap moving = turned(relative);
  for (std::size_t j = 0; j < 3; ++j) {
    const Vec& axis = axes[j];
    by_turn[j] = Vec{dot(stress, second[0][j]), dot(stress, second[1][j]),
                     dot(stress, second[2][j])} -
                 0.5 * cross(load.moment, axis);
    if (constant) continue;
    const Vec slope = along[j].rate;
    const Vec rate_slope = bilinear(axis, along[j], relative, moving) -
                           0.5 * turned(cross(axis, relative)).rate;
    by_turn[j] =
        by_turn[j] + gap.moment(times(stiffness, slope) + times(friction, rate_slope));
    by_spin[j] = gap.moment(times(friction, slope));
  }
  load.by_turn = Matrix3<double>::columns(by_turn[0], by_turn[1], by_turn[2]);
  load.by_spin = Matrix3<double>::columns(by_spin[0], by_spin[1], by_spin[2]);
  return load;
}

}  // namespace tress::models
