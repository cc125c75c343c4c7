#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include "contract/input_error.h"
#include "simulation/export/export.h"

namespace tress::simulation {
namespace {

using nlohmann::ordered_json;

ordered_json array_of(ordered_json one) {
  ordered_json all = ordered_json::array();
  all.push_back(std::move(one));
  return all;
}

/// What the numbers of an accessor are for, as glTF's bufferView.target; none of
/// animations.
enum class Use { animation = 0, vertices = 34962, indices = 34963 };

/// The binary part of a file: arrays after each other, each with a view and an accessor.
class Arrays {
 public:
  /// Number of its accessor; bounds, which glTF wants of places and times, on request.
  std::size_t add(std::span<const float> x, std::size_t width, Use use, bool bounded) {
    constexpr int float32 = 5126;
    ordered_json accessor = described(x.size() / width, width, float32);
    if (bounded) {
      std::vector<double> low(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(width));
      std::vector<double> high = low;
      for (std::size_t i = 0; i < x.size(); ++i) {
        low[i % width] = std::min(low[i % width], static_cast<double>(x[i]));
        high[i % width] = std::max(high[i % width], static_cast<double>(x[i]));
      }
      accessor["min"] = low;
      accessor["max"] = high;
    }
    return put(x, std::move(accessor), use);
  }
  std::size_t add_indices(std::span<const std::uint32_t> x) {
    constexpr int unsigned32 = 5125;
    return put(x, described(x.size(), 1, unsigned32), Use::indices);
  }
  /// Numbers from 0 to 1 in bytes.
  std::size_t add_parts(std::span<const std::uint8_t> x) {
    constexpr int unsigned8 = 5121;
    ordered_json accessor = described(x.size(), 1, unsigned8);
    accessor["normalized"] = true;
    return put(x, std::move(accessor), Use::animation);
  }

  const std::string& bytes() const { return bytes_; }
  void describe(ordered_json& file) const {
    file["accessors"] = accessors_;
    file["bufferViews"] = views_;
    file["buffers"] = array_of({{"byteLength", bytes_.size()}});
  }

 private:
  static ordered_json described(std::size_t count, std::size_t width, int kind) {
    return {{"componentType", kind},
            {"count", count},
            {"type", width == 3 ? "VEC3" : "SCALAR"}};
  }
  template <class T>
  std::size_t put(std::span<const T> x, ordered_json accessor, Use use) {
    ordered_json view{
        {"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", x.size_bytes()}};
    if (use != Use::animation) view["target"] = static_cast<int>(use);
    accessor["bufferView"] = views_.size();
    views_.push_back(std::move(view));
    accessors_.push_back(std::move(accessor));
    bytes_.append(reinterpret_cast<const char*>(x.data()), x.size_bytes());
    bytes_.resize((bytes_.size() + 3) / 4 * 4);  // arrays begin at words
    return accessors_.size() - 1;
  }

  std::string bytes_;
  ordered_json accessors_ = ordered_json::array(), views_ = ordered_json::array();
};

/// A name as that of an attribute of an application: _LOAD_SELF_CONTACT.
std::string attribute_of(std::string_view name) {
  std::string made;
  for (const char c : name) {
    const auto letter = static_cast<unsigned char>(c);
    if (std::isalnum(letter) != 0) {
      made += static_cast<char>(std::toupper(letter));
    } else if (!made.empty() && made.back() != '_') {
      made += '_';
    }
  }
  while (!made.empty() && made.back() == '_') made.pop_back();
  return '_' + made;
}

/// Places and channels of one frame, less those of another.
class Displacements {
 public:
  explicit Displacements(const Animation& animation) : animation_(animation) {}

  /// Of the frame itself, where `from` is none.
  ordered_json of(const Frame3d& frame, const Frame3d* from, Arrays& arrays) const {
    const SmoothLines& curves = animation_.curves;
    std::vector<float> x = curves.positions(frame), values = curves.channels(frame);
    // glTF has finite numbers only.
    for (float& value : values) value = std::isfinite(value) ? value : 0.F;
    if (from != nullptr) {
      subtract(curves.positions(*from), x);
      subtract(curves.channels(*from), values);
    }
    ordered_json attributes{{"POSITION", arrays.add(x, 3, Use::vertices, true)}};
    for (std::size_t c = 0; c < animation_.channels.size(); ++c) {
      const auto channel =
          std::span(values).subspan(c * curves.points(), curves.points());
      attributes[attribute_of(animation_.channels[c].name)] =
          arrays.add(channel, 1, Use::vertices, false);
    }
    return attributes;
  }

 private:
  static void subtract(const std::vector<float>& from, std::vector<float>& x) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      x[i] -= std::isfinite(from[i]) ? from[i] : 0.F;
    }
  }

  const Animation& animation_;
};

/// Strand and radius of every point.
void add_lines(const Animation& animation, Arrays& arrays, ordered_json& attributes) {
  if (animation.lines.empty()) return;
  std::vector<float> radius, strand;
  for (std::size_t k = 0; k < animation.lines.size(); ++k) {
    const auto count = static_cast<std::size_t>(animation.curves.lines()[k]);
    radius.insert(radius.end(), count, static_cast<float>(animation.lines[k].radius));
    strand.insert(strand.end(), count, static_cast<float>(animation.lines[k].strand));
  }
  attributes["_RADIUS"] = arrays.add(radius, 1, Use::vertices, false);
  attributes["_STRAND"] = arrays.add(strand, 1, Use::vertices, false);
}

/// Both ends of every piece of every line.
std::vector<std::uint32_t> pieces(const std::vector<int>& lines) {
  std::vector<std::uint32_t> ends;
  std::uint32_t point = 0;
  for (const int count : lines) {
    for (int i = 0; i + 1 < count; ++i, ++point) {
      ends.insert(ends.end(), {point, point + 1});
    }
    ++point;
  }
  return ends;
}

/// Returns the animation. At the time of frame f the weight of target f - 1 is one and
/// all others are zero. Linear blending of the weights is therefore that of the frames.
ordered_json animation_of(const Animation& animation, Arrays& arrays) {
  const std::size_t frames = animation.frames.size();
  std::vector<float> times;
  for (const Frame3d& frame : animation.frames) {
    const auto time = static_cast<float>(frame.series[0]);
    if (!times.empty() && !(time > times.back())) {
      throw InputError(fmt::format("frames at {} s and {} s are one time in its numbers",
                                   times.back(), frame.series[0]),
                       "export of .glb", "write fewer frames, or .usda or .vtp");
    }
    times.push_back(time);
  }
  std::vector<std::uint8_t> weights(frames * (frames - 1));
  for (std::size_t f = 1; f < frames; ++f) weights[f * (frames - 1) + f - 1] = 255;
  const std::size_t input = arrays.add(times, 1, Use::animation, true);
  const std::size_t output = arrays.add_parts(weights);
  return {
      {"name", "motion"},
      {"channels",
       array_of({{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}})},
      {"samplers",
       array_of({{"input", input}, {"output", output}, {"interpolation", "LINEAR"}})}};
}

void append_word(std::size_t word, std::string& text) {
  const auto value = static_cast<std::uint32_t>(word);
  text.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// A binary file: its header, the description, the arrays.
std::string file_of(std::string description, const std::string& arrays) {
  constexpr std::size_t header = 12, chunk_header = 8, version = 2;
  constexpr std::size_t json_chunk = 0x4E4F534A, binary_chunk = 0x004E4942;
  description.resize((description.size() + 3) / 4 * 4, ' ');
  const std::size_t size =
      header + chunk_header + description.size() + chunk_header + arrays.size();
  if (size > std::numeric_limits<std::uint32_t>::max()) {
    throw InputError(fmt::format("{} bytes", size), "export of .glb",
                     "such files have at most 4 GiB: write fewer frames, or .vtp");
  }
  std::string text = "glTF";
  text.reserve(size);
  append_word(version, text);
  append_word(size, text);
  append_word(description.size(), text);
  append_word(json_chunk, text);
  text += description;
  append_word(arrays.size(), text);
  append_word(binary_chunk, text);
  return text += arrays;
}

}  // namespace

std::string glb(const Animation& animation) {
  const Displacements displacements(animation);
  Arrays arrays;
  const Frame3d& first = animation.frames.front();
  ordered_json attributes = displacements.of(first, nullptr, arrays);
  add_lines(animation, arrays, attributes);
  ordered_json lines{{"mode", 1},
                     {"attributes", std::move(attributes)},
                     {"indices", arrays.add_indices(pieces(animation.curves.lines()))}};
  ordered_json meaning{{"_RADIUS", "radius [m]"}, {"_STRAND", "strand"}};
  for (const Reading& channel : animation.channels) {
    meaning[attribute_of(channel.name)] =
        fmt::format("{} [{}]", channel.name, channel.help);
  }
  // Its y is up, ours is z.
  const double half = std::numbers::sqrt2 / 2;
  ordered_json file{
      {"asset", {{"version", "2.0"}, {"generator", "tress"}}},
      {"scene", 0},
      {"scenes", array_of({{"name", animation.scene.name}, {"nodes", array_of(0)}})},
      {"nodes",
       array_of({{"name", "strands"}, {"mesh", 0}, {"rotation", {-half, 0, 0, half}}})}};
  ordered_json mesh{{"name", "strands"},
                    {"extras", {{"attributes", std::move(meaning)}}}};
  if (animation.frames.size() > 1) {
    ordered_json targets = ordered_json::array();
    for (const Frame3d& frame : animation.frames.subspan(1)) {
      targets.push_back(displacements.of(frame, &first, arrays));
    }
    mesh["weights"] = std::vector<int>(targets.size());
    lines["targets"] = std::move(targets);
    file["animations"] = array_of(animation_of(animation, arrays));
  }
  mesh["primitives"] = array_of(std::move(lines));
  file["meshes"] = array_of(std::move(mesh));
  arrays.describe(file);
  return file_of(file.dump(-1, ' ', false, ordered_json::error_handler_t::replace),
                 arrays.bytes());
}

}  // namespace tress::simulation
