#include "models/effects/obstacle.h"

#include <limits>
#include <utility>

namespace tress::models {
namespace {

constexpr int halvings = 30;  // of the way on which a point comes through the surface

}  // namespace

Obstacle::Obstacle(std::shared_ptr<const RigidBody> body, double offset, double friction)
    : body_(std::move(body)), offset_(offset), friction_(friction) {}

bool Obstacle::near(const Vec& x, double reach, Distance& to) const {
  const std::optional<Distance> found = body_->distance(x, offset_ + reach);
  if (!found) return false;
  to = {found->value - offset_, found->gradient};
  return true;
}

Obstacle::Step::Step(const Obstacle& of, double t, double h)
    : of_(of), h_(h), before_(of.body_->pose(t - h)), after_(of.body_->pose(t)) {}

std::optional<Obstacle::Plane> Obstacle::Step::touch(const Vec& x0, const Vec& x1,
                                                     double reach) const {
  constexpr double anywhere = std::numeric_limits<double>::infinity();
  const Vec from = before_.frame.back(x0 - before_.x),
            to = after_.frame.back(x1 - after_.x);
  Distance at;
  if (!of_.near(to, reach, at)) return {};
  Distance start;
  of_.near(from, anywhere, start);
  Vec place = to;
  if (start.value > 0 && at.value < 0) {
    // From outside: the side it came through, however deep it is now.
    Vec outside = from, inside = to;
    for (int i = 0; i < halvings; ++i) {
      const Vec middle = 0.5 * (outside + inside);
      Distance there;
      of_.near(middle, anywhere, there);
      (there.value > 0 ? outside : inside) = middle;
    }
    place = inside;
    of_.near(place, anywhere, at);
  }
  const double steepness = norm(at.gradient);
  if (!(steepness > 0)) return {};
  const Vec n = (1 / steepness) * at.gradient;
  Plane plane;
  plane.normal = after_.frame * n;
  const Vec world = after_.x + after_.frame * place;
  plane.height = dot(plane.normal, world) - at.value;
  plane.velocity = (1 / h_) * (after_.x + after_.frame * from - x0);
  plane.gap_before = start.value;
  return plane;
}

}  // namespace tress::models
