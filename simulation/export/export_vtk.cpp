#include <fmt/format.h>

#include <cstdint>
#include <numeric>

#include "simulation/export/export.h"
#include "simulation/export/xml_text.h"

namespace tress::simulation {
namespace {

template <class T>
std::string_view raw(const std::vector<T>& x) {
  return {reinterpret_cast<const char*>(x.data()), sizeof(T) * x.size()};
}

}  // namespace

std::string vtp(const Animation& animation, const Frame3d& frame) {
  const std::size_t points = animation.curves.points();
  const std::vector<float> values = animation.curves.channels(frame);
  std::vector<std::int32_t> connectivity(points), offsets;
  std::iota(connectivity.begin(), connectivity.end(), 0);
  std::int32_t end = 0;
  for (const int count : animation.curves.lines()) offsets.push_back(end += count);

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
        values.begin() + static_cast<std::ptrdiff_t>(c * points),
        values.begin() + static_cast<std::ptrdiff_t>((c + 1) * points));
    arrays += fmt::format(
        "<DataArray type=\"Float32\" Name=\"{}\" format=\"appended\" "
        "offset=\"{}\"/>\n",
        xml_text(fmt::format("{} [{}]", animation.channels[c].name,
                             animation.channels[c].help)),
        append(raw(channel)));
  }
  if (!animation.lines.empty()) {
    std::vector<float> radius;
    std::vector<std::int32_t> strand;
    for (std::size_t k = 0; k < animation.lines.size(); ++k) {
      const auto count = static_cast<std::size_t>(animation.curves.lines()[k]);
      radius.insert(radius.end(), count, static_cast<float>(animation.lines[k].radius));
      strand.insert(strand.end(), count, animation.lines[k].strand);
    }
    arrays += fmt::format(
        "<DataArray type=\"Float32\" Name=\"radius [m]\" format=\"appended\" "
        "offset=\"{}\"/>\n<DataArray type=\"Int32\" Name=\"strand\" "
        "format=\"appended\" offset=\"{}\"/>\n",
        append(raw(radius)), append(raw(strand)));
  }
  const std::size_t places = append(raw(animation.curves.positions(frame)));
  const std::size_t lines = append(raw(connectivity));
  const std::size_t ends = append(raw(offsets));
  return fmt::format(
             "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" "
             "byte_order=\"LittleEndian\" header_type=\"UInt32\">\n<PolyData>\n"
             "<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" "
             "NumberOfTuples=\"1\" format=\"ascii\">{}</DataArray>\n</FieldData>\n"
             "<Piece NumberOfPoints=\"{}\" NumberOfLines=\"{}\">\n<PointData>\n{}"
             "</PointData>\n<Points>\n<DataArray type=\"Float32\" "
             "NumberOfComponents=\"3\" format=\"appended\" offset=\"{}\"/>\n</Points>\n"
             "<Lines>\n<DataArray type=\"Int32\" Name=\"connectivity\" "
             "format=\"appended\" offset=\"{}\"/>\n<DataArray type=\"Int32\" "
             "Name=\"offsets\" format=\"appended\" offset=\"{}\"/>\n</Lines>\n</Piece>\n"
             "</PolyData>\n<AppendedData encoding=\"raw\">\n_",
             frame.series[0], points, offsets.size(), arrays, places, lines, ends) +
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
                        animation.frames[f].series[0], xml_text(vtp_name(stem, f)));
  }
  return text + "</Collection>\n</VTKFile>\n";
}

}  // namespace tress::simulation
