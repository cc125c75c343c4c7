#include "experiments/simulate/head_pictures.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "experiments/simulate/head_series.h"
#include "experiments/simulate/pictures.h"
#include "simulation/run/line_curvature.h"
#include "simulation/scene/strand_tables.h"

namespace tress::experiments::scene_runs {
namespace {

constexpr std::size_t most_strands = 1000, most_frames = 50;

std::size_t spread(std::size_t i, std::size_t count, std::size_t all) {
  return count > 1 ? i * (all - 1) / (count - 1) : 0;
}

void add_curvatures(std::size_t points, Frame3d& frame) {
  const std::vector<float>& x = frame.positions;
  for (std::size_t first = 0; 3 * first < x.size(); first += points) {
    const auto at = [&](std::size_t i) {
      const auto entry = [&](std::size_t c) {
        return static_cast<double>(x[3 * (first + i) + c]);
      };
      return Vec{entry(0), entry(1), entry(2)};
    };
    for (std::size_t i = 0; i < points; ++i) {
      frame.channels.push_back(static_cast<float>(line_curvature(at, i, points)));
    }
  }
}

}  // namespace

// Every k-th would lie in strips: the angles of such roots go on by k times the golden
// section, which for many a k is near a fraction of small numbers.
std::vector<std::size_t> shown_strands(std::size_t strands) {
  constexpr double golden = std::numbers::phi - 1;
  const auto angle = [](std::size_t i) {
    const double turns = static_cast<double>(i) * golden;
    return turns - std::floor(turns);
  };
  std::vector<std::size_t> shown(std::min(strands, most_strands));
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const std::size_t end = (i + 1) * strands / shown.size();
    double least = 1;
    for (std::size_t k = i * strands / shown.size(); k < end; ++k) {
      const double apart = std::abs(angle(k) - angle(i)),
                   off = std::min(apart, 1 - apart);
      if (off < least) shown[i] = k;
      least = std::min(least, off);
    }
  }
  return shown;
}

std::size_t shown_frames(std::size_t frames) { return std::min(frames, most_frames); }

void write_head_pictures(const SceneOutline& outline, const HeadFrames& frames,
                         const std::vector<std::size_t>& shown,
                         const SceneRunOptions& options) {
  std::vector<Frame3d> chosen(shown_frames(frames.size()));
  const std::size_t points = outline.scene.strands.front().segments.size() + 1;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const std::size_t frame = spread(i, chosen.size(), frames.size());
    chosen[i].series = frames.series(frame);
    chosen[i].positions = frames.shown(frame);
    add_curvatures(points, chosen[i]);
  }
  std::vector<DrawnLine> lines;
  for (const std::size_t k : shown) {
    const Strand strand = outline.series->strand(k);
    const auto& section = strand.segments.front().section;
    lines.push_back({static_cast<int>(k), std::sqrt(section.a1 * section.a2)});
  }
  const std::vector<int> counts(shown.size(), static_cast<int>(points));
  const std::vector<Reading> channels{{"curvature", "1/m"}};
  const SmoothLines curves(counts, chosen);
  write_pictures(
      {outline.scene, head_series(outline.scene), channels, lines, chosen, curves},
      options);
}

}  // namespace tress::experiments::scene_runs
