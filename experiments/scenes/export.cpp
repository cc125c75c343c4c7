#include "experiments/scenes/export.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>

#include "models/effects/body.h"
#include "models/math/quaternion.h"

namespace tress {
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
  /// 0 .. most, whatever is not finite at 0.
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

nlohmann::ordered_json number(double x) {
  return std::isfinite(x) ? nlohmann::ordered_json(x) : nlohmann::ordered_json();
}

template <class T>
std::string_view raw(const std::vector<T>& x) {
  return {reinterpret_cast<const char*>(x.data()), sizeof(T) * x.size()};
}

nlohmann::ordered_json pose_of(const BodyPose& pose) {
  const Quaternion q = quaternion_of(pose.frame);
  return {pose.x.x, pose.x.y, pose.x.z, q.w, q.v.x, q.v.y, q.v.z};
}

struct Outline {
  std::string_view shape;
  Vec half_axes;  // m; a capsule's z without the caps
};

Outline outline(const Plane&) { return {"plane", {}}; }
Outline outline(const Sphere& s) { return {"sphere", {s.radius, s.radius, s.radius}}; }
Outline outline(const Capsule& c) {
  return {"capsule", {c.radius, c.radius, c.half_length}};
}
Outline outline(const Ellipsoid& e) { return {"ellipsoid", e.half_axes()}; }
Outline outline(const DistanceGrid&) { return {"grid", {}}; }

/// Bodies of the scene at the times of the frames; grids have no outline to draw.
nlohmann::ordered_json bodies(const Scene& scene, const std::vector<double>& times) {
  auto all = nlohmann::ordered_json::array();
  for (const auto& effect : make_effects(scene)) {
    const auto* body = dynamic_cast<const Body*>(effect.get());
    if (body == nullptr) continue;
    const Outline drawn =
        std::visit([](const auto& shape) { return outline(shape); }, body->shape());
    if (drawn.shape == "grid") continue;
    auto poses = nlohmann::ordered_json::array();
    for (const double t : times) poses.push_back(pose_of(body->pose(t)));
    all.push_back(
        {{"shape", drawn.shape},
         {"half_axes_m", {drawn.half_axes.x, drawn.half_axes.y, drawn.half_axes.z}},
         {"poses", std::move(poses)}});
  }
  return all;
}

std::size_t point_count(const Animation& animation) {
  return static_cast<std::size_t>(
      std::accumulate(animation.strand_points.begin(), animation.strand_points.end(), 0));
}

}  // namespace

std::string page_json(const Animation& animation, std::size_t most_bytes) {
  using nlohmann::ordered_json;
  const std::size_t points = point_count(animation);
  // Base64 of 6 bytes of place and one of each channel.
  const std::size_t frame_bytes = points * (6 + animation.channels.size()) * 4 / 3 + 1;
  const std::size_t most = std::max<std::size_t>(most_bytes / frame_bytes, 24);
  const auto chosen = chosen_frames(animation.frames.size(), most);
  const Scene& scene = animation.scene;

  Range box[3];
  // Channels are sizes of something: from nothing on.
  std::vector<Range> ranges(animation.channels.size(), Range{0, 0});
  for (const std::size_t f : chosen) {
    const Frame3d& frame = animation.frames[f];
    for (std::size_t i = 0; i < frame.positions.size(); ++i) {
      box[i % 3].include(static_cast<double>(frame.positions[i]));
    }
    for (std::size_t i = 0; i < frame.channels.size(); ++i) {
      ranges[i / points].include(static_cast<double>(frame.channels[i]));
    }
  }
  std::string places;
  std::vector<std::string> colours(animation.channels.size());
  std::vector<double> times;
  ordered_json rows = ordered_json::array();
  for (const std::size_t f : chosen) {
    const Frame3d& frame = animation.frames[f];
    times.push_back(frame.series[0]);
    for (std::size_t i = 0; i < frame.positions.size(); ++i) {
      const auto u = static_cast<std::uint16_t>(
          box[i % 3].part(static_cast<double>(frame.positions[i]), 65535));
      places += static_cast<char>(u & 255);
      places += static_cast<char>(u >> 8);
    }
    for (std::size_t i = 0; i < frame.channels.size(); ++i) {
      colours[i / points] += static_cast<char>(static_cast<std::uint8_t>(
          ranges[i / points].part(static_cast<double>(frame.channels[i]), 255)));
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
  ordered_json page{{"format", "tress-strands-1"},
                    {"scene", scene.name},
                    {"title", scene.title},
                    {"source", scene.source},
                    {"model", scene.model->id},
                    {"integrator", scene.integrator},
                    {"dt_s", scene.options.step},
                    {"times_s", times},
                    {"strand_points", animation.strand_points},
                    {"low", {box[0].low, box[1].low, box[2].low}},
                    {"high", {box[0].high, box[1].high, box[2].high}},
                    {"positions", base64(places)},
                    {"channels", channels},
                    {"bodies", bodies(scene, times)},
                    {"series", {{"columns", columns}, {"rows", rows}}}};
  if (animation.guides > 0) page["guides"] = animation.guides;
  return page.dump(-1, ' ', false, ordered_json::error_handler_t::replace) + '\n';
}

std::string vtp(const Animation& animation, const Frame3d& frame) {
  const std::size_t points = point_count(animation);
  std::vector<std::int32_t> connectivity(points), offsets;
  std::iota(connectivity.begin(), connectivity.end(), 0);
  std::int32_t end = 0;
  for (const int count : animation.strand_points) offsets.push_back(end += count);

  std::string data;  // of every array: its size in bytes, then the bytes
  const auto append = [&data](std::string_view bytes) {
    const std::size_t at = data.size();
    const auto size = static_cast<std::uint32_t>(bytes.size());
    data.append(reinterpret_cast<const char*>(&size), sizeof size);
    data.append(bytes);
    return at;
  };
  std::string arrays;
  for (std::size_t c = 0; c < animation.channels.size(); ++c) {
    const std::vector<float> channel(
        frame.channels.begin() + static_cast<std::ptrdiff_t>(c * points),
        frame.channels.begin() + static_cast<std::ptrdiff_t>((c + 1) * points));
    arrays += fmt::format(
        "<DataArray type=\"Float32\" Name=\"{} [{}]\" format=\"appended\" "
        "offset=\"{}\"/>\n",
        animation.channels[c].name, animation.channels[c].help, append(raw(channel)));
  }
  const std::size_t places = append(raw(frame.positions));
  const std::size_t lines = append(raw(connectivity));
  const std::size_t ends = append(raw(offsets));
  return fmt::format(
             "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" "
             "byte_order=\"LittleEndian\" header_type=\"UInt32\">\n<PolyData>\n"
             "<Piece NumberOfPoints=\"{}\" NumberOfLines=\"{}\">\n<PointData>\n{}"
             "</PointData>\n<Points>\n<DataArray type=\"Float32\" "
             "NumberOfComponents=\"3\" format=\"appended\" offset=\"{}\"/>\n</Points>\n"
             "<Lines>\n<DataArray type=\"Int32\" Name=\"connectivity\" "
             "format=\"appended\" offset=\"{}\"/>\n<DataArray type=\"Int32\" "
             "Name=\"offsets\" format=\"appended\" offset=\"{}\"/>\n</Lines>\n</Piece>\n"
             "</PolyData>\n<AppendedData encoding=\"raw\">\n_",
             points, offsets.size(), arrays, places, lines, ends) +
         data + "\n</AppendedData>\n</VTKFile>\n";
}

std::string vtp_name(const std::string& stem, std::size_t frame) {
  return fmt::format("{}_{:05}.vtp", stem, frame);
}

std::string pvd(const Animation& animation, const std::string& stem) {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" "
      "byte_order=\"LittleEndian\">\n<Collection>\n";
  for (std::size_t f = 0; f < animation.frames.size(); ++f) {
    text += fmt::format("<DataSet timestep=\"{}\" file=\"{}\"/>\n",
                        animation.frames[f].series[0], vtp_name(stem, f));
  }
  return text + "</Collection>\n</VTKFile>\n";
}

std::string usda(const Animation& animation) {
  const Scene& scene = animation.scene;
  std::string counts;
  for (const int count : animation.strand_points) {
    counts += (counts.empty() ? "" : ", ") + std::to_string(count);
  }
  std::string samples;
  for (std::size_t f = 0; f < animation.frames.size(); ++f) {
    std::string points;
    const std::vector<float>& x = animation.frames[f].positions;
    for (std::size_t i = 0; i + 2 < x.size(); i += 3) {
      points +=
          fmt::format("{}({}, {}, {})", i == 0 ? "" : ", ", x[i], x[i + 1], x[i + 2]);
    }
    samples += fmt::format("            {}: [{}],\n", f, points);
  }
  const double radius =
      scene.strands.empty() ? 1e-3 : scene.strands.front().segments.front().section.a1;
  return fmt::format(
      "#usda 1.0\n(\n    defaultPrim = \"strands\"\n    upAxis = \"Z\"\n"
      "    metersPerUnit = 1\n    startTimeCode = 0\n    endTimeCode = {}\n"
      "    timeCodesPerSecond = {}\n)\n\ndef BasisCurves \"strands\"\n{{\n"
      "    uniform token type = \"linear\"\n    int[] curveVertexCounts = [{}]\n"
      "    float[] widths = [{}] (\n        interpolation = \"constant\"\n    )\n"
      "    point3f[] points.timeSamples = {{\n{}    }}\n}}\n",
      animation.frames.empty() ? 0 : animation.frames.size() - 1, scene.frame_rate,
      counts, 2 * radius, samples);
}

}  // namespace tress
