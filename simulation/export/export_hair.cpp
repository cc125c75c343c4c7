#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>

#include "contract/input_error.h"
#include "simulation/export/export.h"

namespace tress::simulation {

std::string hair(const Animation& animation, const Frame3d& frame) {
  constexpr std::uint32_t has_segments = 1, has_points = 2, has_thickness = 4;
  constexpr std::size_t header = 128;
  const std::vector<int>& counts = animation.curves.lines();
  const std::span<const DrawnLine> lines = animation.lines;
  const float usual = lines.empty() ? 1e-4F : static_cast<float>(2 * lines[0].radius);
  const bool equal = std::ranges::all_of(
      lines, [&](const DrawnLine& line) { return line.radius == lines[0].radius; });
  const auto size = [](std::size_t count) { return static_cast<std::uint32_t>(count); };

  std::string text = "HAIR";
  const auto add = [&text](const auto& x) {
    text.append(reinterpret_cast<const char*>(&x), sizeof x);
  };
  add(size(counts.size()));
  add(size(animation.curves.points()));
  add(has_segments | has_points | (equal ? 0U : has_thickness));
  add(std::uint32_t{0});  // segments of every strand: the array has them
  for (const float x : {usual, 0.F, 0.5F, 0.35F, 0.2F}) add(x);  // and colour
  text += fmt::format("tress: {:.12g} s, m, z up", frame.series[0]);
  text.resize(header);
  for (const int count : counts) {
    if (count - 1 > std::numeric_limits<std::uint16_t>::max()) {
      throw InputError(fmt::format("a line of {} points", count), "export of .hair",
                       "such files have at most 65536 of a strand: write .usda or .vtp");
    }
    add(static_cast<std::uint16_t>(count - 1));
  }
  for (const float x : animation.curves.positions(frame)) add(x);
  if (equal) return text;
  for (std::size_t k = 0; k < counts.size(); ++k) {
    for (int i = 0; i < counts[k]; ++i) add(static_cast<float>(2 * lines[k].radius));
  }
  return text;
}

std::string hair_name(const std::string& stem, std::size_t frame) {
  return fmt::format("{}_{:05}.hair", stem, frame);
}

}  // namespace tress::simulation
