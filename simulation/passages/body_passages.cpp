#include "simulation/passages/body_passages.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace tress::simulation {

StrandPlaces::StrandPlaces(const models::Effects& bodies, std::vector<int> before)
    : spacing_(std::numeric_limits<double>::infinity()), before_(std::move(before)) {
  for (const auto& body : bodies) {
    const auto outline = body->penetration(0, {}) ? body->outline(0) : std::nullopt;
    if (!outline) continue;
    // A capsule's half length, without its caps, may be 0; a plane has no size.
    const Vec& size = outline->half_axes;
    for (const double half : {size.x, size.y, size.z}) {
      if (half > 0) spacing_ = std::min(spacing_, half);
    }
  }
}

template <class Use>
void StrandPlaces::each_between(In like, Use use) const {
  constexpr double most = 64;
  for (std::size_t i = 0; i < before_.size(); ++i) {
    if (before_[i] < 0) continue;
    const auto from = static_cast<std::size_t>(before_[i]);
    const double length = norm(load3(&like[3 * i]) - load3(&like[3 * from]));
    const double pieces = std::clamp(std::ceil(length / spacing_), 1.0, most);
    for (double k = 1; k < pieces; ++k) use(from, i, k / pieces);
  }
}

std::vector<double> StrandPlaces::of(In x, In like) const {
  std::vector<double> places(x.begin(), x.end());
  each_between(like, [&](std::size_t from, std::size_t to, double share) {
    const Vec begin = load3(&x[3 * from]), end = load3(&x[3 * to]);
    const Vec place = begin + share * (end - begin);
    places.insert(places.end(), {place.x, place.y, place.z});
  });
  return places;
}

std::vector<std::size_t> StrandPlaces::ends(In like) const {
  std::vector<std::size_t> ends(before_.size());
  for (std::size_t i = 0; i < ends.size(); ++i) ends[i] = i;
  each_between(like, [&](std::size_t, std::size_t to, double) { ends.push_back(to); });
  return ends;
}

BodyPassages::BodyPassages(const models::Effects& effects, std::vector<int> before)
    : places_(effects, std::move(before)) {
  for (std::size_t i = 0; i < effects.size(); ++i) {
    const models::RigidBody* const body = models::body_of(*effects[i]);
    if (body != nullptr) bodies_.push_back({i, effects[i], body});
  }
}

BodyPassages::Found BodyPassages::find(const models::Paths& paths) const {
  Found found;
  std::vector<double> x, y;
  for (const OneBody& body : bodies_) {
    const double longest = models::passage(*body.body, paths).longest;
    found.longest = std::max(found.longest, longest);
    if (longest <= 1) continue;
    if (x.empty()) {
      x = places_.of(paths.x, paths.y);
      y = places_.of(paths.y);
    }
    const models::Passage passage =
        models::passage(*body.body, {paths.from, paths.to, x, y});
    if (passage.depth <= (found.missed ? found.missed->depth : 0)) continue;
    found.missed = {.body = body.number,
                    .point = places_.ends(paths.y)[passage.point],
                    .t = paths.to,
                    .depth = passage.depth,
                    .needed = (paths.to - paths.from) / passage.over};
  }
  return found;
}

}  // namespace tress::simulation
