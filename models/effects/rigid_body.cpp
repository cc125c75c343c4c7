#include "models/effects/rigid_body.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "contract/input_error.h"

namespace tress::models {
namespace {

bool positive(double x) { return std::isfinite(x) && x > 0; }
bool not_negative(double x) { return std::isfinite(x) && x >= 0; }

bool has_size(const Plane&) { return true; }
bool has_size(const Sphere& s) { return positive(s.radius); }
bool has_size(const Capsule& c) {
  return positive(c.radius) && not_negative(c.half_length);
}
bool has_size(const Ellipsoid& e) {
  const Vec& a = e.half_axes();
  return positive(a.x) && positive(a.y) && positive(a.z);
}
bool has_size(const DistanceGrid&) { return true; }

double least_radius_of(const Plane&) { return std::numeric_limits<double>::infinity(); }
double least_radius_of(const Sphere& s) { return s.radius; }
double least_radius_of(const Capsule& c) { return c.radius; }
double least_radius_of(const Ellipsoid& e) {
  const Vec& a = e.half_axes();
  const double least = std::min({a.x, a.y, a.z}), most = std::max({a.x, a.y, a.z});
  return least * least / most;
}
// What is smaller than some cells is not in the grid.
double least_radius_of(const DistanceGrid& g) { return 4 * g.samples().spacing; }

/// The part of an outline that does not depend on the pose.
struct Drawn {
  std::string_view shape;
  Vec half_axes;
};
Drawn drawn(const Plane&) { return {"plane", {}}; }
Drawn drawn(const Sphere& s) { return {"sphere", {s.radius, s.radius, s.radius}}; }
Drawn drawn(const Capsule& c) { return {"capsule", {c.radius, c.radius, c.half_length}}; }
Drawn drawn(const Ellipsoid& e) { return {"ellipsoid", e.half_axes()}; }
Drawn drawn(const DistanceGrid&) { return {}; }

}  // namespace

RigidBody::RigidBody(BodyShape shape, const StrandPlace& place, double offset,
                     std::optional<RootMotion> motion)
    : shape_(std::move(shape)),
      place_(place),
      offset_(offset),
      motion_(std::move(motion)) {
  if (!std::visit([](const auto& one) { return has_size(one); }, shape_)) {
    throw InputError("its size is not positive or not finite", "effect body",
                     "give radius and half axes > 0, length >= 0 in m");
  }
  if (!not_negative(offset)) {
    throw InputError("the strand's radius is negative or not finite", "effect body",
                     "give a radius >= 0");
  }
  if (!is_rotation(place.frame) || !is_finite(place.x)) {
    throw InputError("its place is not finite or its frame no rotation", "effect body",
                     "give a finite place and orthogonal axes of length 1");
  }
  if (motion_) check(*motion_, "effect body");
  if (const auto* grid = std::get_if<DistanceGrid>(&shape_)) {
    // Between points the interpolant may lie 1.2 spacings below the least value: the
    // negative weights of two directions sum to 0.28, the values differ by 3 sqrt(2).
    const double needed = offset + 2 * grid->samples().spacing;
    if (grid->clearance() < needed) {
      throw InputError("the surface comes too near to the end of the grid", "effect body",
                       "let the two outermost layers be " + std::to_string(needed) +
                           " m and more from it");
    }
  }
}

BodyPose RigidBody::pose(double t) const {
  if (!motion_) return {place_.x, place_.frame, {}, {}};
  const RootPose now = motion_->at(t);
  const auto carry = [&](const Vec& a) { return now.frame * motion_->frame.back(a); };
  const Vec arm = carry(place_.x - motion_->position);
  const Frame& f = place_.frame;
  return {now.x + arm,
          {carry(f.e0), carry(f.e1), carry(f.e2)},
          now.v + cross(now.omega, arm),
          now.omega};
}

std::optional<Outline> RigidBody::outline(double t) const {
  const Drawn of = std::visit([](const auto& shape) { return drawn(shape); }, shape_);
  if (of.shape.empty()) return {};
  const BodyPose now = pose(t);
  return Outline{of.shape, of.half_axes, now.x, now.frame};
}

double RigidBody::least_radius() const {
  return std::visit([](const auto& shape) { return least_radius_of(shape); }, shape_);
}

std::optional<Distance> RigidBody::distance(const Vec& x, double reach) const {
  NearestOf<double> at;
  const auto look = [&](const auto& shape) { return nearest(shape, x, reach, at); };
  if (!std::visit(look, shape_)) return {};
  return at.to;
}

bool RigidBody::reaches(const BodyPose& now, const Ball& ball) const {
  const Vec centre = now.frame.back(ball.centre - now.x);
  return std::visit(
      [&](const auto& shape) {
        return below(shape, centre).value - ball.radius < offset_;
      },
      shape_);
}

/// Calls see(place, distance) for the points at x whose distance is below `reach`.
template <class See>
void RigidBody::for_within(double reach, const BodyPose& now, In x, See see) const {
  const auto look = [&](const auto& shape) {
    for (std::size_t i = 0; i + 2 < x.size(); i += 3) {
      const Vec place = load3(&x[i]);
      NearestOf<double> at;
      if (nearest(shape, now.frame.back(place - now.x), reach, at)) {
        see(place, at.to.value);
      }
    }
  };
  std::visit(look, shape_);
}

double RigidBody::penetration(double t, In x) const {
  double deepest = 0;
  for_within(offset_, pose(t), x, [&](const Vec&, double distance) {
    deepest = std::max(deepest, offset_ - distance);
  });
  return deepest;
}

double RigidBody::surface_speed(double t, In x, double near) const {
  if (!motion_) return 0;
  const BodyPose now = pose(t);
  double fastest = 0;
  for_within(offset_ + near, now, x, [&](const Vec& place, double) {
    fastest = std::max(fastest, norm(now.surface_velocity(place)));
  });
  return fastest;
}

}  // namespace tress::models
