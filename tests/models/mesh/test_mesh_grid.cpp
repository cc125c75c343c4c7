// Grids of mesh files: readers, error, cache and refusals.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "models/mesh/mesh_grid.h"
#include "models/mesh/read_mesh.h"
#include "tests/models/effects/sphere_grid.h"
#include "tests/models/mesh/mesh_files.h"
#include "tests/support/refusal.h"

namespace tress::test_mesh_grid {

using namespace models;
using testing_support::as_obj;
using testing_support::as_ply;
using testing_support::as_stl;
using testing_support::ball;
using testing_support::cube;
using testing_support::refusal;
using testing_support::write_file;

/// A cache folder of the test's own.
class MeshCache : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(TRESS_BINARY_DIR) / "mesh_cache" /
              std::to_string(::getpid());
    setenv("XDG_CACHE_HOME", folder_.c_str(), 1);
  }
  void TearDown() override {
    std::filesystem::remove_all(folder_);
    unsetenv("XDG_CACHE_HOME");
  }
  std::filesystem::path kept() const {
    for (const auto& file : std::filesystem::directory_iterator(folder_ / "tress/meshes"))
      return file.path();
    return {};
  }
  std::filesystem::path folder_;
};

using MeshReader = MeshCache;

// Binary STL keeps single precision: a relative error of 6e-8 in coordinates up to 1.
TEST_F(MeshReader, ReadsOneSurfaceFromThreeKindsOfFile) {
  const TriangleMesh mesh = ball(0.6, 2);
  const std::string files[] = {write_file("ball.obj", as_obj(mesh)),
                               write_file("ball.ply", as_ply(mesh)),
                               write_file("ball.STL", as_stl(mesh))};
  const ClosedSurface exact(mesh, "test");
  for (const std::string& file : files) {
    const ClosedSurface read(read_mesh(file, 1), file);
    EXPECT_EQ(read.mesh().triangle.size(), mesh.triangle.size()) << file;
    EXPECT_EQ(read.mesh().corner.size(), mesh.corner.size()) << file;
    for (const Vec& x : {Vec{0.1, 0.2, 0.3}, Vec{0.9, -0.4, 0.2}, Vec{0, 0, 0.6}}) {
      EXPECT_NEAR(read.distance(x), exact.distance(x), 2e-7) << file;
    }
    const ClosedSurface scaled(read_mesh(file, 0.01), file);
    EXPECT_NEAR(scaled.volume(), 1e-6 * exact.volume(), 1e-6 * 1e-6) << file;
  }
}

TEST_F(MeshReader, RefusesWhatIsNoMesh) {
  const auto refused = [](const std::string& name, const std::string& bytes) {
    const std::string file = write_file(name, bytes);
    return refusal([&] { read_mesh(file, 1); }).substr(0, 60);
  };
  EXPECT_EQ(refused("a.txt", "v 0 0 0\n").substr(0, 15), "not a mesh file");
  EXPECT_EQ(refused("empty.obj", "").substr(0, 11), "no triangle");
  EXPECT_EQ(refused("far.obj", "v 0 0 0\nv 1 0 0\nf 1 2 3\n").substr(0, 27),
            "'3' names no vertex before ");
  EXPECT_EQ(refused("word.obj", "v 0 zero 0\n").substr(0, 37),
            "a vertex without three finite numbers");
  EXPECT_EQ(refused("head.ply", "ply\nformat ascii 1.0\n").substr(0, 27),
            "a header without end_header");
  const std::string stl = as_stl(cube(1));
  EXPECT_EQ(refused("cut.stl", stl.substr(0, stl.size() / 2)).substr(0, 12),
            "neither text");
  EXPECT_EQ(refused("long.ply",
                    "ply\nformat ascii 1.0\nelement vertex 99999999999\nproperty float "
                    "x\nend_header\n0\n")
                .substr(0, 33),
            "99999999999 of vertex in the head");
}

// Polygons, indices from the end, texture corners and comments, as programs write them.
TEST_F(MeshReader, ReadsPolygonsAndIndicesOfObj) {
  const std::string file = write_file(
      "quads.obj",
      "# cube\no one\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nv 0 0 1\nv 1 0 "
      "1\nv 1 1 1\nv 0 1 1\nf 4//1 3//1 2//1 1//1\nf -4 -3 -2 -1\nf 1 2 6 5\n"
      "f 2/1/1 3/1/1 7/1/1 6/1/1\nf 3 4 8 7\nf 4 1 5 8\n");
  const ClosedSurface surface(read_mesh(file, 1), file);
  EXPECT_EQ(surface.mesh().triangle.size(), 12U);
  EXPECT_DOUBLE_EQ(surface.volume(), 1);
}

/// A cube in binary PLY, in either order of bytes, with a property to skip.
std::string binary_ply(const TriangleMesh& m, bool big) {
  std::string to = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                   "_endian 1.0\nelement vertex " + std::to_string(m.corner.size()) +
                   "\nproperty double x\nproperty double y\nproperty uchar "
                   "colour\nproperty double z\nelement face " +
                   std::to_string(m.triangle.size()) +
                   "\nproperty list uchar uint vertex_index\nend_header\n";
  const auto add = [&](auto x) {
    std::string bytes(sizeof x, 0);
    std::memcpy(bytes.data(), &x, sizeof x);
    if (big) std::reverse(bytes.begin(), bytes.end());
    to += bytes;
  };
  for (const Vec& x : m.corner) add(x.x), add(x.y), add(std::uint8_t{7}), add(x.z);
  for (const auto& t : m.triangle) {
    add(std::uint8_t{3});
    for (const std::size_t i : t) add(static_cast<std::uint32_t>(i));
  }
  return to;
}

TEST_F(MeshReader, ReadsBinaryPlyInBothOrders) {
  for (const bool big : {false, true}) {
    const std::string file = write_file("binary.ply", binary_ply(cube(0.5), big));
    const ClosedSurface surface(read_mesh(file, 1), file);
    EXPECT_DOUBLE_EQ(surface.volume(), 1);
  }
}

// Cut anywhere or with a byte changed, a file is read or refused, and nothing else.
TEST_F(MeshReader, SurvivesDamage) {
  const TriangleMesh mesh = cube(0.5);
  const std::pair<const char*, std::string> files[] = {
      {"damaged.obj", as_obj(mesh)},
      {"damaged.ply", as_ply(mesh)},
      {"damaged2.ply", binary_ply(mesh, true)},
      {"damaged.stl", as_stl(mesh)},
      {"damaged2.stl",
       "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 "
       "0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n"}};
  int refused = 0, read = 0;
  for (const auto& [name, whole] : files) {
    for (std::size_t i = 0; i < whole.size(); i += 3) {
      std::string changed = whole;
      changed[i] = static_cast<char>(changed[i] ^ (1 << (i % 7)));
      for (const std::string& bytes : {whole.substr(0, i), changed}) {
        const std::string file = write_file(name, bytes);
        ++(refusal([&] { read_mesh(file, 1); }).empty() ? read : refused);
      }
    }
  }
  EXPECT_GT(refused, 500);
  EXPECT_GT(read, 200);
}

// Half a spacing beside the upper faces, as here, edges are cut by a part of the spacing,
// which falls with it. The stated error holds at the corners, which it includes.
TEST_F(MeshReader, StatesTheErrorOfTheGrid) {
  const ClosedSurface surface(cube(0.5), "cube");
  double before = 0.05;
  for (const double spacing : {1 / 23.5, 1 / 47.5, 1 / 95.5}) {
    const MeshGrid made = mesh_grid(surface, {.spacing = spacing}, "cube");
    EXPECT_LT(made.error, spacing);
    EXPECT_GT(made.error, 0);
    EXPECT_LT(made.error, 0.7 * before);
    EXPECT_GE(made.error, std::abs(made.grid.distance({0.5, 0.5, 0.5}).value));
    // Far from edges the distance is linear, which the convolution reproduces.
    EXPECT_NEAR(made.grid.distance({0.52, 0.1, 0.2}).value, 0.02, 1e-12);
    before = made.error;
  }
}

TEST_F(MeshReader, RefusesSurfacesThatMeetThemselvesAndTooFineGrids) {
  TriangleMesh two = cube(0.5);
  const TriangleMesh other = cube(0.5, {0.4, 0.3, 0.2});
  for (const Vec& x : other.corner) two.corner.push_back(x);
  for (const auto& t : other.triangle) {
    two.triangle.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  }
  const ClosedSurface surface(two, "two.obj");
  EXPECT_NE(refusal([&] {
              mesh_grid(surface, {}, "two.obj");
            }).find("the mesh intersects itself"),
            std::string::npos);
  EXPECT_NE(refusal([&] {
              mesh_grid(ClosedSurface(cube(0.5), "c"), {.spacing = 1e-4}, "c.obj");
            }).find("take mesh_spacing_m above 0.00"),
            std::string::npos);
  // A body thinner than some spacings would vanish between the points.
  EXPECT_NE(refusal([&] {
              mesh_grid(ClosedSurface(cube(0.5), "c"), {.spacing = 0.3}, "c.obj");
            }).find("take mesh_spacing_m of 0.25 or less"),
            std::string::npos);
}

TEST_F(MeshCache, KeepsTheGridAndSeesDamage) {
  const std::string file = write_file("kept.obj", as_obj(ball(0.6, 2)));
  const MeshGrid first = read_mesh_grid(file, {.spacing = 0.1});
  const std::filesystem::path cached = kept();
  ASSERT_FALSE(cached.empty());
  const auto equal = [&](const MeshGrid& again) {
    return again.grid.samples().value == first.grid.samples().value &&
           again.error == first.error && again.triangles == first.triangles;
  };
  EXPECT_TRUE(equal(read_mesh_grid(file, {.spacing = 0.1})));
  // What the file says is read: one value changed, with no checksum to go with it.
  {
    std::fstream damaged(cached, std::ios::in | std::ios::out | std::ios::binary);
    damaged.seekp(400);
    damaged.put('x');
  }
  EXPECT_TRUE(equal(read_mesh_grid(file, {.spacing = 0.1})));
  EXPECT_NE(read_mesh_grid(file, {.spacing = 0.05}).grid.samples().nx,
            first.grid.samples().nx);
  setenv("XDG_CACHE_HOME", "/proc/no such folder", 1);
  EXPECT_TRUE(equal(read_mesh_grid(file, {.spacing = 0.1})));
}

}  // namespace tress::test_mesh_grid
