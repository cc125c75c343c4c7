#include "simulation/groom/read_groom.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <new>
#include <numeric>

#include "contract/input_error.h"

namespace tress::simulation {
namespace {

std::string ending_of(const std::string& file) {
  std::string ending = std::filesystem::path(file).extension().string();
  for (char& c : ending) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return ending;
}

Vec float_place(ByteStream& from, std::size_t floats) {
  float x[7];
  from.take(x, floats * sizeof(float));
  return Vec3<float>(x[0], x[1], x[2]);
}

/// Arrays of a .hair file, each there if its bit is set.
struct HairArray {
  std::uint32_t bit;
  std::uint64_t bytes;  // of a strand, or of a point
  bool of_strand;
};
constexpr std::uint32_t has_segments = 1, has_points = 2, has_widths = 4;
constexpr HairArray hair_arrays[] = {{has_segments, sizeof(std::uint16_t), true},
                                     {has_points, 3 * sizeof(float), false},
                                     {has_widths, sizeof(float), false},
                                     {8, sizeof(float), false},
                                     {16, 3 * sizeof(float), false}};
constexpr std::uint64_t hair_header = 128;

/// Refuses a file that is longer or shorter than its header says.
void check_hair_size(const ByteStream& from, std::uint32_t strands, std::uint32_t points,
                     std::uint32_t bits) {
  std::uint64_t size = hair_header;
  std::uint32_t known = 0;
  for (const HairArray& array : hair_arrays) {
    known |= array.bit;
    if ((bits & array.bit) == 0) continue;
    size += array.bytes * (array.of_strand ? strands : points);
  }
  if ((bits & ~known) != 0) {
    from.refuse(fmt::format("array bits {}, of which the format has 1 to 31", bits),
                "the file is damaged: write it again");
  }
  if (size == from.size()) return;
  from.refuse(
      fmt::format("{} bytes where {} strand{} of {} points with array bits {} "
                  "have {}",
                  from.size(), strands, strands == 1 ? "" : "s", points, bits, size),
      "the file is cut short, damaged or has more than its strands: write it "
      "again");
}

/// Strands of these points each, three floats a point.
void float_strands(ByteStream& from, const std::vector<std::uint32_t>& each,
                   Polylines& lines) {
  lines.ends.reserve(each.size());
  for (std::size_t k = 0; k < each.size(); ++k) {
    const std::uint64_t place = from.at();
    for (std::uint32_t i = 0; i < each[k]; ++i) {
      lines.points.push_back(float_place(from, 3));
    }
    lines.end_strand(k, place);
  }
}

/// Points of each strand, from one number a strand that is `less` by one, or the same.
std::vector<std::uint32_t> counts_of(ByteStream& from, std::uint32_t strands,
                                     std::uint32_t less) {
  std::vector<std::uint16_t> read(strands);
  if (!read.empty()) from.take(read.data(), read.size() * sizeof read[0]);
  std::vector<std::uint32_t> each(read.begin(), read.end());
  for (std::uint32_t& count : each) count += less;
  return each;
}

std::uint64_t sum_of(const std::vector<std::uint32_t>& each) {
  return std::accumulate(each.begin(), each.end(), std::uint64_t{0});
}

/// A file that begins with its counts, and whose size is what they say; none: it is not
/// one.
std::optional<GroomFile> read_headless(ByteStream& from) {
  constexpr std::uint64_t header = 2 * sizeof(std::uint32_t);
  from.seek(0);
  if (from.size() < header) return std::nullopt;
  const auto strands = from.number<std::uint32_t>(),
             points = from.number<std::uint32_t>();
  const std::uint64_t size = header + sizeof(std::uint16_t) * std::uint64_t{strands} +
                             3 * sizeof(float) * std::uint64_t{points};
  if (strands == 0 || size != from.size()) return std::nullopt;
  std::vector<std::uint32_t> each = counts_of(from, strands, 0);
  if (sum_of(each) + strands == points) {
    for (std::uint32_t& count : each) ++count;  // they are segments
  }
  if (sum_of(each) != points) return std::nullopt;
  GroomFile made;
  made.lines.points.reserve(points);
  float_strands(from, each, made.lines);
  made.notes.push_back("the file has no header: its counts and its size agree");
  return made;
}

}  // namespace

GroomFile read_hair(ByteStream& from, const GroomReading& reading) {
  char magic[4] = {};
  if (from.size() >= sizeof magic) from.take(magic, sizeof magic);
  const std::string_view word(magic, sizeof magic);
  if (word != "HAIR" && word != "hair") {
    if (auto headless = read_headless(from)) return *std::move(headless);
    throw InputError(
        "the file begins neither with HAIR nor with counts that its size confirms",
        from.file() + ": byte 0",
        "other formats use this ending, too: name a file of i32 counts before the points "
        "of each strand (HairSalon) .data, or export it as .usda");
  }
  const auto strands = from.number<std::uint32_t>();
  const auto points = from.number<std::uint32_t>();
  const auto bits = from.number<std::uint32_t>();
  const auto segments = from.number<std::uint32_t>();
  if ((bits & has_points) == 0) {
    from.refuse(fmt::format("array bits {} are without points", bits),
                "write the file with its points");
  }
  const auto width = from.number<float>();  // where there is no array of widths
  check_hair_size(from, strands, points, bits);
  from.seek(hair_header);
  // No more than there are points: each strand has one at least.
  if (strands > points) {
    from.refuse(fmt::format("{} strands of {} points in all", strands, points),
                "the file is damaged: write it again");
  }
  const std::uint64_t counts_at = from.at();
  const auto each = (bits & has_segments) != 0
                        ? counts_of(from, strands, 1)
                        : std::vector<std::uint32_t>(
                              strands, std::min<std::uint32_t>(segments, points) + 1);
  if (const std::uint64_t total = sum_of(each); total != points) {
    throw InputError(
        fmt::format("strands of {} points where the header has {}", total, points),
        fmt::format("{}: byte {}", from.file(), counts_at),
        "the file is damaged: write it again");
  }
  GroomFile made;
  made.lines.points.reserve(points);
  float_strands(from, each, made.lines);
  if (!reading.widths) return made;
  if ((bits & has_widths) != 0) {
    made.lines.widths.resize(points);
    for (double& of_point : made.lines.widths) of_point = from.number<float>();
  } else if (width > 0) {
    made.lines.widths.assign(points, width);
  }
  return made;
}

GroomFile read_counted(ByteStream& from, int floats) {
  const auto strands = from.number<std::int32_t>();
  if (strands < 0) {
    throw InputError(fmt::format("{} strands", strands), from.file() + ": byte 0",
                     "the file is damaged, or of another format");
  }
  from.require(static_cast<std::uint64_t>(strands), sizeof(std::int32_t), "strands");
  GroomFile made;
  const auto wide = static_cast<std::size_t>(floats);
  const std::uint64_t bytes_of_point = wide * sizeof(float);
  for (std::int32_t k = 0; k < strands; ++k) {
    const std::uint64_t place = from.at();
    const auto count = from.number<std::int32_t>();
    if (count < 0) {
      throw InputError(fmt::format("strand {} has {} points", k, count),
                       fmt::format("{}: byte {}", from.file(), place),
                       "the file is damaged, or of another format");
    }
    from.require(static_cast<std::uint64_t>(count), bytes_of_point,
                 fmt::format("points of strand {}", k));
    for (std::int32_t i = 0; i < count; ++i) {
      made.lines.points.push_back(float_place(from, wide));
    }
    made.lines.end_strand(static_cast<std::size_t>(k), place);
  }
  if (from.left() > 0) {
    from.refuse(fmt::format("{} bytes are left after the last strand", from.left()),
                floats == 3
                    ? "the file is of another format: name it .bin if a point has "
                      "seven floats"
                    : "the file is of another format: name it .data if a point "
                      "has three floats");
  }
  return made;
}

GroomFile read_groom(const std::string& file, const GroomReading& reading) {
  const std::string ending = ending_of(file);
  ByteStream from(file);
  if (reading.strand_points > 0 && ending != ".ply") {
    throw InputError("strand_points is for .ply files alone", file, "leave it out");
  }
  if (reading.hidden && ending != ".usda") {
    throw InputError("hidden_strands is for .usda files alone", file, "leave it out");
  }
  try {
    if (ending == ".hair") return read_hair(from, reading);
    if (ending == ".data") return read_counted(from, 3);
    if (ending == ".bin") return read_counted(from, 7);
    if (ending == ".ply") return read_ply(from, reading.strand_points);
    if (ending == ".usda") return read_usda(from, reading);
    if (ending == ".vtp") return read_vtp(from);
  } catch (const std::bad_alloc&) {
    from.refuse(
        fmt::format("strands of a file of {} bytes need more memory than there is",
                    from.size()),
        "give a part of the file");
  }
  const bool binary_usd = ending == ".usd" || ending == ".usdc" || ending == ".usdz";
  throw InputError(fmt::format("strands are not read from '{}'", ending), file,
                   binary_usd ? "write it as text: usdcat -o strands.usda"
                              : "give a .hair, .data, .bin, .ply, .usda or .vtp");
}

}  // namespace tress::simulation
