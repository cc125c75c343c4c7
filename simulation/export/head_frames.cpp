#include "simulation/export/head_frames.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <limits>
#include <numeric>

#include "contract/input_error.h"
#include "simulation/export/xml_text.h"
#include "simulation/files/checksum.h"
#include "simulation/files/files.h"

namespace tress::simulation {
namespace {

// A whole number of blocks of any lanes; half a megabyte of ten elements, so that chunks
// are enough for many threads and not many for HDF5.
constexpr std::size_t most_strands_of_chunk = 2048;
// Of zlib: higher ones take several times as long and save a few percent of positions.
constexpr int zlib_level = 1;
constexpr std::size_t no_memory =
    std::numeric_limits<std::size_t>::max();  // size of none

constexpr const char* series_name = "series";
constexpr const char* shown_positions = "shown/positions";

template <class T>
std::string_view bytes_of(std::span<const T> x) {
  return {reinterpret_cast<const char*>(x.data()), sizeof(T) * x.size()};
}

/// As `Number` behind each other.
template <class Number>
void put(std::span<const double> x, char* to) {
  for (const double entry : x) {
    const auto number = static_cast<Number>(entry);
    std::memcpy(to, &number, sizeof number);
    to += sizeof number;
  }
}

std::string joined(const std::vector<std::string>& words) {
  std::string all;
  for (const std::string& word : words) all += (all.empty() ? "" : ",") + word;
  return all;
}

}  // namespace

std::string HeadFrames::dataset(std::size_t frame) {
  return fmt::format("positions/{:06}", frame);
}

HeadFrames::HeadFrames(const std::string& stem, StrandCount head, StoredFrames stored,
                       Hdf5File::Mode mode)
    : stem_(stem),
      stored_(std::move(stored)),
      strands_(head.strands),
      points_(head.points),
      each_(std::min(most_strands_of_chunk, strands_)),
      file_(stem + ".h5", mode),
      chunks_((strands_ + each_ - 1) / each_),
      sizes_(chunks_.size()),
      chunk_sums_(chunks_.size()),
      shown_(3 * points_ * stored_.shown.size()) {}

HeadFrames::HeadFrames(const std::string& stem, const Scene& scene, StrandCount head,
                       StoredFrames stored)
    : HeadFrames(stem, head, std::move(stored), Hdf5File::Mode::create) {
  file_.set("scene", scene.name);
  file_.set("title", scene.title);
  file_.set("model", std::string(scene.model->id));
  file_.set("integrator", scene.integrator);
  if (scene.options.tolerance > 0) {
    file_.set("position_tol_rel", scene.options.tolerance);
  } else {
    file_.set("dt_s", scene.options.step);
  }
  file_.set("columns", joined(stored_.columns));
  file_.set("strands", static_cast<double>(strands_));
  file_.set("points", static_cast<double>(points_));
  const std::size_t columns = stored_.columns.size(), shown = stored_.shown.size();
  file_.create(series_name, {Hdf5Type::float64, {0, columns}, {64, columns}});
  file_.create(
      shown_positions,
      {Hdf5Type::float32, {0, points_ * shown, 3}, {1, points_ * shown, 3}, zlib_level});
  file_.create("shown/strands", {Hdf5Type::int32, {1, shown}, {1, shown}});
  const std::vector<std::int32_t> strands(stored_.shown.begin(), stored_.shown.end());
  file_.write("shown/strands", 0, std::span<const std::int32_t>(strands));
  if (stored_.bits == 0) return;
  file_.create("connectivity",
               {Hdf5Type::int32, {strands_, points_}, {each_, points_}, zlib_level});
  for (std::size_t k = 0; k < strands_; k += each_) {
    std::vector<std::int32_t> points(std::min(each_, strands_ - k) * points_);
    std::iota(points.begin(), points.end(), static_cast<std::int32_t>(k * points_));
    file_.write("connectivity", k, std::span<const std::int32_t>(points));
  }
}

HeadFrames::HeadFrames(const std::string& stem, StrandCount head, StoredFrames stored,
                       std::vector<std::uint64_t> sums, const FileState& state)
    : HeadFrames((restore(stem + ".h5", state), stem), head, std::move(stored),
                 Hdf5File::Mode::extend) {
  const auto damaged = [&] {
    return InputError("frames are missing or damaged: their checksum does not fit",
                      stem + ".h5", "leave out --resume to begin again");
  };
  const auto fits = [&](const std::string& name, const std::vector<std::size_t>& want) {
    return file_.has(name) && file_.size(name) == want;
  };
  if (!fits(series_name, {sums.size(), stored_.columns.size()}) ||
      !fits(shown_positions, {sums.size(), points_ * stored_.shown.size(), 3})) {
    throw damaged();
  }
  try {
    for (std::size_t frame = 0; frame < sums.size(); ++frame) {
      if (stored_.bits != 0 && !fits(dataset(frame), {strands_ * points_, 3})) {
        throw damaged();
      }
      for (std::size_t c = 0; stored_.bits != 0 && c < chunks_.size(); ++c) {
        const std::vector<char> bytes = file_.read_chunk(dataset(frame), place_of(c));
        chunk_sums_[c] = Checksum().add({bytes.data(), bytes.size()}).value();
      }
      shown_ = shown(frame);
      if (sum(series(frame)) != sums[frame]) throw damaged();
    }
  } catch (const InputError&) {  // or HDF5 finds no such chunk
    throw damaged();
  }
  sums_ = std::move(sums);
}

std::vector<std::size_t> HeadFrames::place_of(std::size_t chunk) const {
  return {chunk * each_ * points_, 0};
}

std::size_t HeadFrames::at_once(std::size_t workers) {
  return most_strands_of_chunk * workers;
}

void HeadFrames::take(Crew& crew, std::size_t first, std::span<const double> x) {
  const std::size_t numbers = 3 * points_;
  own_.resize(crew.workers());
  for (Own& own : own_) {
    own.raw.resize(numbers * each_ * static_cast<std::size_t>(stored_.bits) / 8);
    own.shuffled.resize(own.raw.size());
  }
  const std::size_t begin = first / each_, chunk = numbers * each_;
  crew.run((x.size() + chunk - 1) / chunk, [&](std::size_t c, std::size_t worker) {
    take_chunk(begin + c, x.subspan(c * chunk, std::min(chunk, x.size() - c * chunk)),
               own_[worker]);
  });
  if (std::ranges::count(sizes_, no_memory) > 0) {
    throw InputError("cannot compress a frame", stem_ + ".h5", "free memory");
  }
}

/// A chunk ends with zeros where there are no more strands.
void HeadFrames::take_chunk(std::size_t chunk, std::span<const double> x, Own& own) {
  const std::size_t size = static_cast<std::size_t>(stored_.bits) / 8;
  std::ranges::fill(std::span(own.raw).subspan(size * x.size()), '\0');
  if (size == 8) put<double>(x, own.raw.data());
  if (size == 4) put<float>(x, own.raw.data());
  shuffle(own.raw, size, own.shuffled);
  std::vector<char>& to = chunks_[chunk];
  to.resize(::compressBound(own.raw.size()));
  uLongf used = to.size();
  const int result = ::compress2(reinterpret_cast<Bytef*>(to.data()), &used,
                                 reinterpret_cast<const Bytef*>(own.shuffled.data()),
                                 own.shuffled.size(), zlib_level);
  sizes_[chunk] = result == Z_OK ? used : no_memory;
  chunk_sums_[chunk] =
      Checksum().add({to.data(), result == Z_OK ? sizes_[chunk] : 0}).value();
}

void HeadFrames::take_shown(std::span<const double> x) {
  std::ranges::transform(x, shown_.begin(),
                         [](double entry) { return static_cast<float>(entry); });
}

std::uint64_t HeadFrames::sum(std::span<const double> series) const {
  Checksum all;
  if (stored_.bits != 0) all.add(bytes_of(std::span(chunk_sums_)));
  all.add(bytes_of(series));
  all.add(bytes_of(std::span(shown_)));
  return all.value();
}

void HeadFrames::write(std::span<const double> series) {
  const std::size_t frame = sums_.size();
  if (stored_.bits != 0) {
    file_.create(dataset(frame),
                 {stored_.bits == 64 ? Hdf5Type::float64 : Hdf5Type::float32,
                  {strands_ * points_, 3},
                  {each_ * points_, 3},
                  zlib_level});
    for (std::size_t c = 0; c < chunks_.size(); ++c) {
      file_.write_chunk(dataset(frame), place_of(c),
                        std::span(chunks_[c]).first(sizes_[c]));
    }
  }
  file_.resize(shown_positions, frame + 1);
  file_.write(shown_positions, frame, std::span<const float>(shown_));
  file_.resize(series_name, frame + 1);
  file_.write(series_name, frame, series);
  sums_.push_back(sum(series));
  file_.flush();
}

void HeadFrames::sync() {
  file_.sync();
  if (stored_.bits != 0) replace_file(stem_ + ".xdmf", xdmf());
}

FileState HeadFrames::state() {
  for (; placed_ < size(); ++placed_) {
    written_.push_back(file_.place(shown_positions, {placed_, 0, 0}));
    for (std::size_t c = 0; stored_.bits != 0 && c < chunks_.size(); ++c) {
      written_.push_back(file_.place(dataset(placed_), place_of(c)));
    }
  }
  return state_of(stem_ + ".h5", written_);
}

std::vector<double> HeadFrames::series(std::size_t frame) const {
  std::vector<double> row(stored_.columns.size());
  file_.read(series_name, frame, std::span(row));
  return row;
}

std::vector<float> HeadFrames::shown(std::size_t frame) const {
  std::vector<float> x(3 * points_ * stored_.shown.size());
  file_.read(shown_positions, frame, std::span(x));
  return x;
}

std::string HeadFrames::xdmf() const {
  const std::string file =
      xml_text(std::filesystem::path(stem_).filename().string() + ".h5");
  std::string text = fmt::format(
      "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n<Domain>\n"
      "<Grid Name=\"strands\" GridType=\"Collection\" CollectionType=\"Temporal\">\n");
  for (std::size_t frame = 0; frame < size(); ++frame) {
    text += fmt::format(
        "<Grid Name=\"strands\" GridType=\"Uniform\">\n<Time Value=\"{}\"/>\n"
        "<Topology TopologyType=\"Polyline\" NodesPerElement=\"{}\" "
        "NumberOfElements=\"{}\">\n<DataItem Format=\"HDF\" NumberType=\"Int\" "
        "Precision=\"4\" Dimensions=\"{} {}\">{}:/connectivity</DataItem>\n</Topology>\n",
        series(frame).front(), points_, strands_, strands_, points_, file);
    text += fmt::format(
        "<Geometry GeometryType=\"XYZ\">\n<DataItem Format=\"HDF\" "
        "NumberType=\"Float\" Precision=\"{}\" Dimensions=\"{} 3\">{}:/{}</DataItem>\n"
        "</Geometry>\n</Grid>\n",
        stored_.bits / 8, strands_ * points_, file, dataset(frame));
  }
  return text + "</Grid>\n</Domain>\n</Xdmf>\n";
}

}  // namespace tress::simulation
