#include "simulation/run/body_depth.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tress::simulation {

BodyDepth::BodyDepth(const models::Effects& effects, MaterialPoints& points)
    : spacing_(std::numeric_limits<double>::infinity()) {
  for (const auto& effect : effects) {
    if (!effect->penetration(0, {})) continue;
    bodies_.push_back(effect);
    const auto outline = effect->outline(0);
    if (!outline) continue;
    // A capsule's half length, without its caps, may be 0; a plane has no size.
    const Vec& size = outline->half_axes;
    for (const double half : {size.x, size.y, size.z}) {
      if (half > 0) spacing_ = std::min(spacing_, half);
    }
  }
  for (int i = 0; i < points.count(); ++i) before_.push_back(points.before(i));
  x_.resize(3 * before_.size());
}

void BodyDepth::look(MaterialPoints& points, double t, In q) {
  constexpr double most = 64;
  points.positions(t, q, x_);
  places_ = x_;
  for (std::size_t i = 0; i < before_.size(); ++i) {
    if (before_[i] < 0) continue;
    const Vec to = load3(&x_[3 * i]),
              from = load3(&x_[3 * static_cast<std::size_t>(before_[i])]);
    const double pieces = std::clamp(std::ceil(norm(to - from) / spacing_), 1.0, most);
    for (double k = 1; k < pieces; ++k) {
      const Vec place = from + (k / pieces) * (to - from);
      places_.insert(places_.end(), {place.x, place.y, place.z});
    }
  }
  for (const auto& body : bodies_) {
    deepest = std::max(deepest, body->penetration(t, places_).value_or(0));
  }
}

}  // namespace tress::simulation
