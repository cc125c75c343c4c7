#include "tests/support/groom_bytes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

namespace tress::testing_support {
namespace {

using simulation::Polylines;

template <class T>
void put(std::string& to, T x, bool reversed = false) {
  char bytes[sizeof x];
  std::copy_n(reinterpret_cast<const char*>(&x), sizeof x, bytes);
  if (reversed) std::reverse(bytes, bytes + sizeof x);
  to.append(bytes, sizeof x);
}

void put_place(std::string& to, const Vec& x, bool reversed = false) {
  for (const double c : {x.x, x.y, x.z}) put(to, static_cast<float>(c), reversed);
}

template <class T>
T whole(std::size_t n) {
  return static_cast<T>(n);
}

std::string hair_bytes(const Polylines& lines) {
  std::string text = "HAIR";
  put(text, whole<std::uint32_t>(lines.size()));
  put(text, whole<std::uint32_t>(lines.points.size()));
  put(text, std::uint32_t{3});
  text.resize(128);
  for (std::size_t k = 0; k < lines.size(); ++k) {
    put(text, whole<std::uint16_t>(lines.strand(k).size() - 1));
  }
  for (const Vec& x : lines.points) put_place(text, x);
  return text;
}

std::string counted_bytes(const Polylines& lines, int more) {
  std::string text;
  put(text, whole<std::int32_t>(lines.size()));
  for (std::size_t k = 0; k < lines.size(); ++k) {
    put(text, whole<std::int32_t>(lines.strand(k).size()));
    for (const Vec& x : lines.strand(k)) {
      put_place(text, x);
      for (int i = 0; i < more; ++i) put(text, 0.5F);
    }
  }
  return text;
}

std::string ply_bytes(const Polylines& lines, std::string_view form) {
  std::string text = fmt::format(
      "ply\nformat {} 1.0\ncomment made for a test\nelement vertex {}\nproperty float x\n"
      "property float y\nproperty float z\nelement strand {}\nproperty int nsegs\n"
      "end_header\n",
      form, lines.points.size(), lines.size());
  const bool big = form == "binary_big_endian";
  for (const Vec& x : lines.points) {
    if (form != "ascii") {
      put_place(text, x, big);
    } else {
      text += fmt::format("{} {} {}\n", static_cast<float>(x.x), static_cast<float>(x.y),
                          static_cast<float>(x.z));
    }
  }
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const auto segments = whole<std::int32_t>(lines.strand(k).size() - 1);
    if (form != "ascii") {
      put(text, segments, big);
    } else {
      text += fmt::format("{}\n", segments);
    }
  }
  return text;
}

std::string usda_bytes(const Polylines& lines) {
  std::string counts, points;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    counts += fmt::format("{}{}", k > 0 ? ", " : "", lines.strand(k).size());
  }
  for (std::size_t i = 0; i < lines.points.size(); ++i) {
    const Vec& x = lines.points[i];
    points += fmt::format("{}({}, {}, {})", i > 0 ? ", " : "", static_cast<float>(x.x),
                          static_cast<float>(x.y), static_cast<float>(x.z));
  }
  return fmt::format(
      "#usda 1.0\n(\n    doc = \"\"\"hair ( of a test\"\"\"\n    metersPerUnit = 1\n"
      "    upAxis = \"Z\"\n)\n\ndef Xform \"head\" (\n    kind = \"component\"\n)\n{{\n"
      "    float3 xformOp:rotateXYZ = (0, -0, 0)\n    float3 xformOp:scale = (1, 1, 1)\n"
      "    uniform token[] xformOpOrder = [\"xformOp:rotateXYZ\", \"xformOp:scale\"]\n"
      "    def BasisCurves \"hair\"\n    {{\n"
      "        float3[] extent = [(0, 0, 0), (1, 1, 1)]\n"
      "        rel material:binding = </head/black>\n"
      "        uniform token type = \"linear\"\n        int[] curveVertexCounts = [{}]\n"
      "        point3f[] points = [{}] (\n            interpolation = \"vertex\"\n"
      "        )\n    }}\n}}\n",
      counts, points);
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      word = word << 8 |
             (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k <= bytes.size() ? digits[word >> (18 - 6 * k) & 63U] : '=';
    }
  }
  return text;
}

std::string vtp_bytes(const Polylines& lines, std::string_view format) {
  std::string appended;
  const auto array = [&](std::string_view type, std::string_view name,
                         const std::string& bytes, const std::string& text) {
    std::string sized;
    put(sized, whole<std::uint32_t>(bytes.size()));
    sized += bytes;
    if (format == "appended") {
      const std::size_t offset = appended.size();
      appended += sized;
      return fmt::format(
          "<DataArray type=\"{}\" Name=\"{}\" format=\"appended\" offset=\"{}\"/>\n",
          type, name, offset);
    }
    return fmt::format(
        "<DataArray type=\"{}\" Name=\"{}\" format=\"{}\">\n{}\n</DataArray>\n", type,
        name, format, format == "ascii" ? text : base64(sized));
  };
  std::string places, ids, ends, places_text, ids_text, ends_text;
  for (std::size_t i = 0; i < lines.points.size(); ++i) {
    const Vec& x = lines.points[i];
    put_place(places, x);
    put(ids, whole<std::int64_t>(i));
    places_text += fmt::format("{} {} {}\n", static_cast<float>(x.x),
                               static_cast<float>(x.y), static_cast<float>(x.z));
    ids_text += fmt::format("{} ", i);
  }
  for (const std::size_t end : lines.ends) {
    put(ends, whole<std::int64_t>(end));
    ends_text += fmt::format("{} ", end);
  }
  std::string text = fmt::format(
      "<?xml version=\"1.0\"?>\n<!-- of a test -->\n<VTKFile type=\"PolyData\" "
      "byte_order=\"LittleEndian\" header_type=\"UInt32\">\n<PolyData>\n<Piece "
      "NumberOfPoints=\"{}\" NumberOfLines=\"{}\">\n<PointData/>\n<Points>\n{}</Points>\n"
      "<Lines>\n{}{}</Lines>\n</Piece>\n</PolyData>\n",
      lines.points.size(), lines.size(), array("Float32", "Points", places, places_text),
      array("Int64", "connectivity", ids, ids_text),
      array("Int64", "offsets", ends, ends_text));
  if (format == "appended") {
    text += "<AppendedData encoding=\"raw\">\n_" + appended + "\n</AppendedData>\n";
  }
  return text + "</VTKFile>\n";
}

}  // namespace

std::string groom_bytes(std::string_view format, const Polylines& lines) {
  if (format == "hair") return hair_bytes(lines);
  if (format == "data") return counted_bytes(lines, 0);
  if (format == "bin") return counted_bytes(lines, 4);
  if (format == "ply") return ply_bytes(lines, "ascii");
  if (format == "ply.little") return ply_bytes(lines, "binary_little_endian");
  if (format == "ply.big") return ply_bytes(lines, "binary_big_endian");
  if (format == "usda") return usda_bytes(lines);
  if (format == "vtp") return vtp_bytes(lines, "ascii");
  return vtp_bytes(lines, format.substr(4));
}

}  // namespace tress::testing_support
