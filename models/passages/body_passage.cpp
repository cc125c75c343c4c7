#include "models/passages/body_passage.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "models/effects/body.h"
#include "models/effects/exact_body.h"
#include "models/effects/obstacle.h"

namespace tress::models {
namespace {

double half_thickness(const Plane&) { return std::numeric_limits<double>::infinity(); }
double half_thickness(const Sphere& s) { return s.radius; }
double half_thickness(const Capsule& c) { return c.radius; }
double half_thickness(const Ellipsoid& e) {
  const Vec& a = e.half_axes();
  return std::min({a.x, a.y, a.z});
}
// Thinner parts are not in the grid.
double half_thickness(const DistanceGrid& g) { return 2 * g.samples().spacing; }

/// Returns the largest depth (m) on the straight path from a to b, if both are outside
/// and on opposite sides: the normals differ by more than a right angle. Otherwise 0: a
/// path over the edge of a ball by less than that is 0.3 of its radius deep at most.
template <class Shape>
double depth_between(const Shape& shape, const Vec& a, const Vec& b, double offset) {
  constexpr double most_places = 1000;
  const Vec way = b - a;
  const double length = norm(way);
  if (below(shape, 0.5 * (a + b)).value - 0.5 * length >= offset) return 0;
  // Off a grid there is no normal.
  const auto side = [](const Distance& to, const Vec& away) {
    return norm(to.gradient) > 0 ? to.gradient : away;
  };
  const Distance from = shape.distance(a), to = shape.distance(b);
  if (!(from.value >= offset && to.value >= offset)) return 0;
  if (!(dot(side(from, -1 * way), side(to, way)) < 0)) return 0;
  double depth = 0;
  const double pieces =
      std::min(std::ceil(4 * length / half_thickness(shape)), most_places);
  for (double k = 1; k < pieces; ++k) {
    depth = std::max(depth, offset - shape.distance(a + (k / pieces) * way).value);
  }
  return depth;
}

}  // namespace

Passage passage(const RigidBody& body, const Paths& paths) {
  Passage found;
  const auto look = [&](const auto& shape) {
    const double half = half_thickness(shape);
    if (!std::isfinite(half)) return;
    const BodyPose before = body.pose(paths.from), after = body.pose(paths.to);
    for (std::size_t i = 0; i + 2 < paths.x.size(); i += 3) {
      const Vec from = before.frame.back(load3(&paths.x[i]) - before.x),
                to = after.frame.back(load3(&paths.y[i]) - after.x);
      const double over = norm(to - from) / half;
      if (!std::isfinite(over)) continue;
      found.longest = std::max(found.longest, over);
      if (over <= 1) continue;
      const double depth = depth_between(shape, from, to, body.offset());
      if (depth <= found.depth) continue;
      found.depth = depth;
      found.point = i / 3;
      found.over = over;
    }
  };
  std::visit(look, body.shape());
  return found;
}

const RigidBody* body_of(const Effect& effect) {
  if (const auto* one = dynamic_cast<const Body*>(&effect)) {
    return &one->contact_on_points().body;
  }
  if (const auto* one = dynamic_cast<const ExactBody*>(&effect)) return &one->body();
  if (const auto* one = dynamic_cast<const Obstacle*>(&effect)) return &one->body();
  return nullptr;
}

}  // namespace tress::models
