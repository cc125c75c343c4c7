#include "simulation/groom/read_groom.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

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

}  // namespace

GroomFile read_hair(ByteStream& from) {
  char magic[4];
  from.take(magic, sizeof magic);
  const std::string_view word(magic, sizeof magic);
  if (word != "HAIR" && word != "hair") {
    throw InputError(
        "the file does not begin with HAIR", from.file() + ": byte 0",
        "other formats use this ending, too: name HairSalon's layout (counts and three "
        "floats of each point) .data");
  }
  const auto strands = from.number<std::uint32_t>();
  const auto points = from.number<std::uint32_t>();
  const auto bits = from.number<std::uint32_t>();
  const auto segments = from.number<std::uint32_t>();
  constexpr std::uint64_t header = 128;
  constexpr std::uint32_t has_segments = 1, has_points = 2;
  if ((bits & has_points) == 0) {
    from.refuse(fmt::format("array bits {} are without points", bits),
                "write the file with its points");
  }
  from.seek(header);
  GroomFile made;
  const bool counted = (bits & has_segments) != 0;
  if (counted) from.require(strands, sizeof(std::uint16_t), "strands");
  std::vector<std::uint16_t> each(counted ? strands : 0);
  const std::uint64_t counts_at = from.at();
  if (!each.empty()) from.take(each.data(), each.size() * sizeof each[0]);
  std::uint64_t total = 0;
  for (std::uint32_t k = 0; k < strands && total <= points; ++k) {
    total += (counted ? each[k] : std::uint64_t{segments}) + 1;
  }
  if (total != points) {
    throw InputError(fmt::format("strands of {}{} points where the header says {}",
                                 total > points ? "more than " : "",
                                 total > points ? std::uint64_t{points} : total, points),
                     fmt::format("{}: byte {}", from.file(), counts_at),
                     "the file is damaged: write it again");
  }
  from.require(points, 3 * sizeof(float), "points");
  made.lines.points.reserve(points);
  made.lines.ends.reserve(strands);
  for (std::uint32_t k = 0; k < strands; ++k) {
    const std::uint64_t place = from.at();
    const std::uint64_t count = (counted ? each[k] : std::uint64_t{segments}) + 1;
    for (std::uint64_t i = 0; i < count; ++i) {
      made.lines.points.push_back(float_place(from, 3));
    }
    made.lines.end_strand(k, place);
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
  made.lines.points.reserve(from.left() / bytes_of_point);
  made.lines.ends.reserve(static_cast<std::size_t>(strands));
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

GroomFile read_groom(const std::string& file, int strand_points) {
  const std::string ending = ending_of(file);
  ByteStream from(file);
  if (strand_points > 0 && ending != ".ply") {
    throw InputError("strand_points is for .ply files alone", file, "leave it out");
  }
  if (ending == ".hair") return read_hair(from);
  if (ending == ".data") return read_counted(from, 3);
  if (ending == ".bin") return read_counted(from, 7);
  if (ending == ".ply") return read_ply(from, strand_points);
  if (ending == ".usda") return read_usda(from);
  if (ending == ".vtp") return read_vtp(from);
  const bool binary_usd = ending == ".usd" || ending == ".usdc" || ending == ".usdz";
  throw InputError(fmt::format("strands are not read from '{}'", ending), file,
                   binary_usd ? "write it as text: usdcat -o strands.usda"
                              : "give a .hair, .data, .bin, .ply, .usda or .vtp");
}

}  // namespace tress::simulation
