#include "models/mesh/read_mesh.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <vector>

#include "contract/input_error.h"
#include "contract/read_file.h"
#include "models/mesh/mesh_text.h"
#include "models/mesh/read_ply_mesh.h"

namespace tress::models {
namespace {

constexpr std::size_t most_mesh_bytes = std::size_t{1} << 30;

/// The ending of a name in small letters, without the dot.
std::string ending_of(const std::string& file) {
  const std::size_t dot = file.find_last_of("./");
  if (dot == std::string::npos || file[dot] == '/') return {};
  std::string end = file.substr(dot + 1);
  std::ranges::transform(end, end.begin(), [](unsigned char c) {
    return static_cast<char>(std::tolower(c));
  });
  return end;
}

/// The corner that `word` (such as 7, 7/1, 7//3 or -1) names of those read so far.
std::size_t obj_corner(const MeshText& from, std::string_view word, std::size_t known) {
  const std::string_view text = word.substr(0, word.find('/'));
  long long at = 0;
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, at);
  const auto count = static_cast<long long>(known);
  if (end != last || error != std::errc{} || at == 0 || at > count || at < -count) {
    from.refuse("'" + std::string(word.substr(0, 40)) + "' names no vertex before it");
  }
  return static_cast<std::size_t>(at > 0 ? at - 1 : count + at);
}

TriangleMesh read_obj(MeshText& from) {
  TriangleMesh mesh;
  std::vector<std::size_t> corners;
  while (!from.ended()) {
    std::string_view line = from.line();
    const std::string_view word = first_word(line);
    if (word == "v") {
      MeshText numbers("", line);
      std::array<double, 3> x;
      try {
        for (double& one : x) one = numbers.number();
      } catch (const InputError&) {
        from.refuse("a vertex without three finite numbers");
      }
      mesh.corner.push_back({x[0], x[1], x[2]});
    } else if (word == "f") {
      corners.clear();
      for (std::string_view one = first_word(line); !one.empty();
           one = first_word(line)) {
        corners.push_back(obj_corner(from, one, mesh.corner.size()));
      }
      add_polygon(corners, mesh);
    }
  }
  return mesh;
}

void add_triangle(const std::array<Vec, 3>& corners, TriangleMesh& to) {
  const std::size_t first = to.corner.size();
  to.corner.insert(to.corner.end(), corners.begin(), corners.end());
  to.triangle.push_back({first, first + 1, first + 2});
}

TriangleMesh read_text_stl(MeshText& from) {
  TriangleMesh mesh;
  std::vector<Vec> corners;
  for (std::string_view word = from.word(); !word.empty(); word = from.word()) {
    if (word == "vertex") {
      const double x = from.number(), y = from.number(), z = from.number();
      corners.push_back({x, y, z});
    }
    if (word != "endfacet") continue;
    if (corners.size() != 3) from.refuse("a facet without three vertices");
    add_triangle({corners[0], corners[1], corners[2]}, mesh);
    corners.clear();
  }
  if (!corners.empty()) from.refuse("the file ends inside a facet");
  return mesh;
}

/// 80 bytes, the number of triangles, and 50 bytes for each.
TriangleMesh read_binary_stl(MeshText& from, std::size_t triangles) {
  from.turn_binary();
  TriangleMesh mesh;
  for (std::size_t t = 0; t < triangles; ++t) {
    for (int i = 0; i < 3; ++i) from.binary<float>(false);
    std::array<Vec, 3> corners;
    for (Vec& x : corners) {
      for (double* one : {&x.x, &x.y, &x.z}) {
        *one = static_cast<double>(from.binary<float>(false));
      }
    }
    from.binary<std::uint16_t>(false);
    add_triangle(corners, mesh);
  }
  return mesh;
}

TriangleMesh read_stl(const std::string& file, std::string_view bytes) {
  MeshText from(file, bytes);
  constexpr std::size_t head = 84, each = 50;
  if (bytes.size() >= head) {
    MeshText count(file, bytes.substr(80));
    const std::size_t triangles = count.binary<std::uint32_t>(false);
    if (triangles == (bytes.size() - head) / each && (bytes.size() - head) % each == 0) {
      MeshText rest(file, bytes.substr(head));
      return read_binary_stl(rest, triangles);
    }
  }
  if (bytes.starts_with("solid")) return read_text_stl(from);
  from.refuse("neither text that begins with solid nor a binary STL of this size");
}

}  // namespace

TriangleMesh read_mesh(const std::string& file, double scale) {
  const std::string end = ending_of(file);
  refuse_if(end != "obj" && end != "ply" && end != "stl", "not a mesh file", file,
            "name a file that ends in .obj, .ply or .stl");
  const std::string bytes = read_file(file, most_mesh_bytes);
  MeshText from(file, bytes);
  TriangleMesh mesh = end == "obj"   ? read_obj(from)
                      : end == "ply" ? read_ply_mesh(from)
                                     : read_stl(file, bytes);
  refuse_if(mesh.triangle.empty(), "no triangle", file,
            "write the mesh again with its faces");
  for (Vec& x : mesh.corner) {
    x = scale * x;
    refuse_if(!is_finite(x), "a corner of the mesh is not finite", file,
              "write the mesh again");
  }
  return mesh;
}

}  // namespace tress::models
