#include "simulation/rest/overlap_at_start.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "math/closest.h"

namespace tress::simulation {
namespace {

/// Points of a strand and their bounds.
struct Line {
  std::vector<Vec> points;
  Vec low, high;
};

Line line_of(In x) {
  Line line;
  line.low = line.high = load3(x.data());
  for (std::size_t i = 0; i < x.size(); i += 3) {
    const Vec p = load3(&x[i]);
    line.points.push_back(p);
    line.low = {std::min(line.low.x, p.x), std::min(line.low.y, p.y),
                std::min(line.low.z, p.z)};
    line.high = {std::max(line.high.x, p.x), std::max(line.high.y, p.y),
                 std::max(line.high.z, p.z)};
  }
  return line;
}

bool boxes_within(const Line& a, const Line& b, double reach) {
  const Vec one = b.low - a.high, other = a.low - b.high;
  return std::max({one.x, one.y, one.z, other.x, other.y, other.z}) < reach;
}

/// Returns the least distance of two lines without their first pieces, which roots hold,
/// or `reach` if that is less.
double distance_of(const Line& a, const Line& b, double reach) {
  if (!boxes_within(a, b, reach)) return reach;
  for (std::size_t i = 2; i < a.points.size(); ++i) {
    const StraightPiece first(a.points[i - 1], a.points[i]);
    for (std::size_t j = 2; j < b.points.size(); ++j) {
      const StraightPiece second(b.points[j - 1], b.points[j]);
      const NearestPoints at = nearest(first, second);
      reach = std::min(reach, norm(first.at(at.of_first) - second.at(at.of_second)));
    }
  }
  return reach;
}

}  // namespace

std::string overlap_at_start(const Scene& scene, const std::vector<int>& points, In x) {
  const Parameters* rubs = scene.friction();
  const double thickness = rubs == nullptr ? 0 : rubs->number("thickness_m");
  if (thickness == 0) return {};
  std::vector<Line> lines;
  for (std::size_t k = 0, first = 0; k < points.size(); ++k) {
    const auto numbers = 3 * static_cast<std::size_t>(points[k]);
    lines.push_back(line_of(x.subspan(first, numbers)));
    first += numbers;
  }
  double nearest = thickness / 2;
  std::size_t one = 0, other = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (std::size_t j = i + 1; j < lines.size(); ++j) {
      const double distance = distance_of(lines[i], lines[j], nearest);
      if (distance >= nearest) continue;
      nearest = distance;
      one = i;
      other = j;
    }
  }
  if (other == 0) return {};
  return fmt::format(
      "strands {} and {} overlap by {:.3g} m at t = 0: move them {:.3g} m apart, or take "
      "a thickness_m below {:.3g}",
      one, other, thickness - nearest, thickness, nearest);
}

}  // namespace tress::simulation
