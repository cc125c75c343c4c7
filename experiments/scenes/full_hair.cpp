#include "experiments/scenes/full_hair.h"

#include <algorithm>

#include "experiments/scenes/guide_hair.h"
#include "models/input_error.h"

namespace tress {
namespace {

/// What has turned the head since its rest.
Frame turned(const RootMotion& head, double t) {
  const Frame now = head.at(t).frame;
  const auto column = [&](const Vec& axis) { return now * head.frame.back(axis); };
  return {column({1, 0, 0}), column({0, 1, 0}), column({0, 0, 1})};
}

}  // namespace

FullHair::FullHair(const Animation& guides, std::size_t hairs, std::uint64_t seed)
    : guides_(guides) {
  if (hairs == 0) return;
  const auto& lines = guides.strand_points;
  const Scene& scene = guides.scene;
  const bool alike = std::ranges::all_of(lines, [&](int n) { return n == lines[0]; });
  if (scene.strands.size() < 3 || lines.size() != scene.strands.size() || !alike) {
    throw InputError(
        "hairs between strands need three strands or more, all of as many "
        "elements",
        "--hairs", "leave it out for scene " + scene.name);
  }
  std::vector<Vec> roots;
  for (const Strand& strand : scene.strands) roots.push_back(strand.root.position);
  const auto points = static_cast<std::size_t>(lines[0]);
  const GuideHair hair(roots, scatter_roots(roots, hairs, seed), points, {.seed = seed});

  lines_.assign(lines.begin(), lines.end());
  lines_.insert(lines_.end(), hairs, lines[0]);
  const std::size_t simulated = roots.size() * points, drawn = hairs * points;
  std::vector<Vec> of_guides(simulated), places(drawn);
  const std::size_t stride = (guides.frames.size() + 59) / 60;
  for (std::size_t f = 0; f < guides.frames.size(); f += stride) {
    const Frame3d& frame = guides.frames[f];
    Frame3d full{frame.series, frame.positions, {}};
    for (std::size_t i = 0; i < simulated; ++i) {
      of_guides[i] = load3(&frame.positions[3 * i]);
    }
    hair.grow(of_guides, turned(scene.head, frame.series[0]), places);
    for (const Vec& x : places) {
      for (const double c : {x.x, x.y, x.z}) {
        full.positions.push_back(static_cast<float>(c));
      }
    }
    for (std::size_t c = 0; c < guides.channels.size(); ++c) {
      const auto of_channel =
          frame.channels.begin() + static_cast<std::ptrdiff_t>(c * simulated);
      full.channels.insert(full.channels.end(), of_channel,
                           of_channel + static_cast<std::ptrdiff_t>(simulated));
      for (std::size_t h = 0; h < hairs; ++h) {
        const auto own = of_channel + static_cast<std::ptrdiff_t>(
                                          hair.neighbours(h).guide[0] * points);
        full.channels.insert(full.channels.end(), own,
                             own + static_cast<std::ptrdiff_t>(points));
      }
    }
    frames_.push_back(std::move(full));
  }
}

Animation FullHair::animation() const {
  if (lines_.empty()) return guides_;
  return {guides_.scene, guides_.series, guides_.channels,
          lines_,        frames_,        guides_.strand_points.size()};
}

}  // namespace tress
