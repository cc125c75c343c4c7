#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "simulation/export/export.h"

namespace tress::simulation {
namespace {

/// The box of these points, wider by `margin` on all sides.
std::string extent(const std::vector<float>& x, float margin) {
  constexpr float infinite = std::numeric_limits<float>::infinity();
  float low[3] = {infinite, infinite, infinite},
        high[3] = {-infinite, -infinite, -infinite};
  for (std::size_t i = 0; i < x.size(); ++i) {
    low[i % 3] = std::min(low[i % 3], x[i]);
    high[i % 3] = std::max(high[i % 3], x[i]);
  }
  return fmt::format("[({}, {}, {}), ({}, {}, {})]", low[0] - margin, low[1] - margin,
                     low[2] - margin, high[0] + margin, high[1] + margin,
                     high[2] + margin);
}

}  // namespace

std::string usda(const Animation& animation) {
  const Scene& scene = animation.scene;
  // Frames need not be all frames of the scene.
  const auto time_code = [&](const Frame3d& frame) {
    return frame.series[0] * scene.frame_rate;
  };
  double widest = 0.002;
  if (!animation.lines.empty()) {
    widest =
        2 * std::ranges::max_element(animation.lines, {}, &DrawnLine::radius)->radius;
  }
  std::string samples, extents;
  for (const Frame3d& frame : animation.frames) {
    std::string points;
    const std::vector<float> x = animation.curves.positions(frame);
    for (std::size_t i = 0; i + 2 < x.size(); i += 3) {
      points +=
          fmt::format("{}({}, {}, {})", i == 0 ? "" : ", ", x[i], x[i + 1], x[i + 2]);
    }
    samples += fmt::format("            {:.12g}: [{}],\n", time_code(frame), points);
    extents += fmt::format("            {:.12g}: {},\n", time_code(frame),
                           extent(x, static_cast<float>(widest / 2)));
  }
  std::vector<double> widths;
  std::vector<int> strands;
  for (const DrawnLine& line : animation.lines) {
    widths.push_back(2 * line.radius);
    strands.push_back(line.strand);
  }
  const std::string attributes =
      widths.empty()
          ? "    float[] widths = [0.002] (\n        interpolation = \"constant\"\n    "
            ")\n"
          : fmt::format(
                "    float[] widths = [{}] (\n        interpolation = \"uniform\"\n"
                "    )\n    int[] primvars:strand = [{}] (\n        interpolation = "
                "\"uniform\"\n    )\n",
                fmt::join(widths, ", "), fmt::join(strands, ", "));
  return fmt::format(
      "#usda 1.0\n(\n    defaultPrim = \"strands\"\n    upAxis = \"Z\"\n"
      "    metersPerUnit = 1\n    startTimeCode = 0\n    endTimeCode = {:.12g}\n"
      "    timeCodesPerSecond = {}\n)\n\ndef BasisCurves \"strands\"\n{{\n"
      "    uniform token type = \"linear\"\n    int[] curveVertexCounts = [{}]\n"
      "{}    float3[] extent.timeSamples = {{\n{}    }}\n"
      "    point3f[] points.timeSamples = {{\n{}    }}\n}}\n",
      animation.frames.empty() ? 0 : time_code(animation.frames.back()), scene.frame_rate,
      fmt::join(animation.curves.lines(), ", "), attributes, extents, samples);
}

}  // namespace tress::simulation
