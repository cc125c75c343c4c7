#include "simulation/export/export.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>

#include "math/quaternion.h"
#include "models/effects/driven_body.h"
#include "simulation/run/body_columns.h"

namespace tress::simulation {
namespace {

std::string base64(std::string_view bytes) {
  constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t left = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      word = word << 8 | (k < left ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += k <= left ? digits[word >> (18 - 6 * k) & 63U] : '=';
    }
  }
  return text;
}

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void include(double x) {
    if (!std::isfinite(x)) return;
    low = std::min(low, x);
    high = std::max(high, x);
  }
  /// Maps x to 0 .. most; 0 if it is not finite.
  double part(double x, double most) const {
    if (!(high > low) || !std::isfinite(x)) return 0;
    return std::round(most * std::clamp((x - low) / (high - low), 0.0, 1.0));
  }
};

std::vector<std::size_t> chosen_frames(std::size_t all, std::size_t most) {
  const std::size_t count = std::min(all, most);
  std::vector<std::size_t> chosen(count);
  for (std::size_t i = 0; i < count; ++i) {
    chosen[i] = count > 1 ? i * (all - 1) / (count - 1) : 0;
  }
  return chosen;
}

/// To four digits: enough for a picture.
double rounded(double x) {
  if (x == 0 || !std::isfinite(x)) return 0;
  const double unit = std::pow(10, 3 - std::floor(std::log10(std::abs(x))));
  return std::round(x * unit) / unit;
}

nlohmann::ordered_json number(double x) {
  return std::isfinite(x) ? nlohmann::ordered_json(x) : nlohmann::ordered_json();
}

nlohmann::ordered_json pose_of(const Outline& body) {
  const Quaternion q = quaternion_of(body.frame);
  return {body.x.x, body.x.y, body.x.z, q.w, q.v.x, q.v.y, q.v.z};
}

/// Place of a body in a frame, which has the columns of one that strands drive.
Outline outline_in(const Animation& animation, const Frame3d& frame, const Effect& effect,
                   const std::string& name) {
  if (const auto* driven = dynamic_cast<const models::DrivenBody*>(&effect)) {
    driven->move_to(place_in(*driven, name, animation.series, frame.series));
  }
  return *effect.outline(frame.series[0]);
}

/// Bodies of the scene in the chosen frames.
nlohmann::ordered_json bodies(const Animation& animation,
                              std::span<const std::size_t> chosen) {
  auto all = nlohmann::ordered_json::array();
  const std::vector<std::string> names = effect_names(animation.scene);
  const Effects effects = make_effects(animation.scene);
  for (std::size_t i = 0; i < effects.size(); ++i) {
    const auto& effect = effects[i];
    const std::optional<Outline> drawn = effect->outline(0);
    if (!drawn) continue;
    auto poses = nlohmann::ordered_json::array();
    for (const std::size_t f : chosen) {
      poses.push_back(
          pose_of(outline_in(animation, animation.frames[f], *effect, names[i])));
    }
    all.push_back(
        {{"shape", drawn->shape},
         {"half_axes_m", {drawn->half_axes.x, drawn->half_axes.y, drawn->half_axes.z}},
         {"poses", std::move(poses)}});
  }
  return all;
}

/// Forces of contacts and supports in the frames, of each the largest ones: a picture of
/// more is none.
nlohmann::ordered_json contacts(std::span<const Frame3d> frames,
                                std::span<const std::size_t> chosen) {
  constexpr std::size_t most = 300;
  constexpr std::size_t numbers = 6;  // of a contact
  auto all = nlohmann::ordered_json::array();
  bool any = false;
  for (const std::size_t f : chosen) {
    std::vector<float> x = frames[f].contacts;
    x.insert(x.end(), frames[f].reactions.begin(), frames[f].reactions.end());
    const auto size = [&](std::size_t i) {
      return std::hypot(x[numbers * i + 3], x[numbers * i + 4], x[numbers * i + 5]);
    };
    std::vector<std::size_t> order(x.size() / numbers);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, std::greater{}, size);
    order.resize(std::min(order.size(), most));
    auto frame = nlohmann::ordered_json::array();
    for (const std::size_t i : order) {
      for (std::size_t c = 0; c < numbers; ++c) {
        frame.push_back(rounded(static_cast<double>(x[numbers * i + c])));
      }
    }
    any = any || !order.empty();
    all.push_back(std::move(frame));
  }
  return any ? all : nlohmann::ordered_json();
}

}  // namespace

std::vector<DrawnLine> drawn_lines(const Scene& scene, const World& world,
                                   std::span<const int> lines) {
  std::vector<DrawnLine> drawn;
  std::size_t line = 0;
  for (std::size_t k = 0; k < scene.strands.size(); ++k) {
    const auto& section = scene.strands[k].segments.front().section;
    const DrawnLine of_strand{static_cast<int>(k), std::sqrt(section.a1 * section.a2)};
    int left = world.points()[k] - lines[line++];
    drawn.push_back(of_strand);
    // Branches begin at a point of another line.
    for (; left > 0; ++line) {
      left -= lines[line] - 1;
      drawn.push_back(of_strand);
    }
  }
  return drawn;
}

std::string page_json(const Animation& animation, std::size_t most_bytes) {
  using nlohmann::ordered_json;
  const SmoothLines& curves = animation.curves;
  const std::size_t points = curves.points();
  // Base64 of 6 bytes of position and one of each channel.
  const std::size_t frame_bytes = points * (6 + animation.channels.size()) * 4 / 3 + 1;
  const std::size_t most = std::max<std::size_t>(most_bytes / frame_bytes, 24);
  const auto chosen = chosen_frames(animation.frames.size(), most);
  const Scene& scene = animation.scene;

  Range box[3];
  // Channels are magnitudes: their ranges start at 0.
  std::vector<Range> ranges(animation.channels.size(), Range{0, 0});
  std::vector<std::vector<float>> positions, values;  // of the chosen frames
  for (const std::size_t f : chosen) {
    positions.push_back(curves.positions(animation.frames[f]));
    values.push_back(curves.channels(animation.frames[f]));
    for (std::size_t i = 0; i < positions.back().size(); ++i) {
      box[i % 3].include(static_cast<double>(positions.back()[i]));
    }
    for (std::size_t i = 0; i < values.back().size(); ++i) {
      ranges[i / points].include(static_cast<double>(values.back()[i]));
    }
  }
  std::string places;
  std::vector<std::string> colours(animation.channels.size());
  std::vector<double> times;
  ordered_json rows = ordered_json::array();
  for (std::size_t c = 0; c < chosen.size(); ++c) {
    times.push_back(animation.frames[chosen[c]].series[0]);
    for (std::size_t i = 0; i < positions[c].size(); ++i) {
      const auto u = static_cast<std::uint16_t>(
          box[i % 3].part(static_cast<double>(positions[c][i]), 65535));
      places += static_cast<char>(u & 255);
      places += static_cast<char>(u >> 8);
    }
    for (std::size_t i = 0; i < values[c].size(); ++i) {
      colours[i / points] += static_cast<char>(static_cast<std::uint8_t>(
          ranges[i / points].part(static_cast<double>(values[c][i]), 255)));
    }
  }
  for (const Frame3d& frame : animation.frames) {
    ordered_json row = ordered_json::array();
    for (const double x : frame.series) row.push_back(number(x));
    rows.push_back(std::move(row));
  }
  ordered_json channels = ordered_json::array();
  for (std::size_t c = 0; c < ranges.size(); ++c) {
    channels.push_back({{"name", animation.channels[c].name},
                        {"unit", animation.channels[c].help},
                        {"low", number(ranges[c].low)},
                        {"high", number(ranges[c].high)},
                        {"values", base64(colours[c])}});
  }
  ordered_json columns = ordered_json::array();
  for (const Reading& column : animation.series) columns.push_back(column.name);
  ordered_json page{
      {"format", "tress-strands-1"},
      {"scene", scene.name},
      {"title", scene.title},
      {"source", scene.source},
      {"model", scene.model->id},
      {"integrator", scene.integrator},
      {"dt_s",
       scene.options.tolerance > 0 ? ordered_json() : ordered_json(scene.options.step)},
      {"times_s", times},
      {"strand_points", curves.lines()},
      {"low", {box[0].low, box[1].low, box[2].low}},
      {"high", {box[0].high, box[1].high, box[2].high}},
      {"positions", base64(places)},
      {"channels", channels},
      {"bodies", bodies(animation, chosen)},
      {"series", {{"columns", columns}, {"rows", rows}}}};
  if (auto touching = contacts(animation.frames, chosen); !touching.is_null()) {
    page["contacts"] = std::move(touching);
  }
  if (animation.guides > 0) page["guides"] = animation.guides;
  if (!animation.lines.empty()) {
    std::vector<int> ids;
    std::vector<double> radii;
    for (const DrawnLine& line : animation.lines) {
      ids.push_back(line.strand);
      radii.push_back(line.radius);
    }
    page["strand_ids"] = ids;
    page["radius_m"] = radii;
  }
  return page.dump(-1, ' ', false, ordered_json::error_handler_t::replace) + '\n';
}

}  // namespace tress::simulation
