// Bodies that are meshes, against the same bodies in closed form.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <string>

#include "simulation/head/head_run.h"
#include "simulation/head/scene_head.h"
#include "simulation/run/world.h"
#include "tests/models/effects/sphere_grid.h"
#include "tests/models/mesh/mesh_files.h"
#include "tests/support/refusal.h"

namespace tress::test_mesh_body {

using namespace simulation;
using testing_support::as_obj;
using testing_support::ball;
using testing_support::refusal;
using testing_support::write_file;

/// A strand that falls on a ball, at rest on it or sliding off, and one that a moving
/// ball pushes. The mesh has its corners on the sphere: its faces lie within e^2/(6 r) =
/// 0.17 mm of it (e: edges of 7 mm), and the strand's points with them.
TEST(MeshBody, HoldsAndPushesAStrandAsTheSphereDoes) {
  setenv("XDG_CACHE_HOME", TRESS_BINARY_DIR "/mesh_cache/bodies", 1);
  const std::string file = write_file("pushing.obj", as_obj(ball(0.05, 4)));
  for (const char* model : {"super_helix", "der"}) {
    for (const char* moves :
         {"",
          "moves = \"keyframes\"\nkeyframes = [[0, 0, 0, 0, 0], [0.3, 0.03, 0, 0, "
          "0]]\n"}) {
      const auto end = [&](const std::string& shape) {
        World world(parse_scene(
            std::string("title = \"mesh\"\nduration_s = 0.3\n[model]\nid = \"") + model +
                "\"\n[integrator]\nid = \"backward_euler\"\ndt_s = 1e-3\n[material]\n"
                "name = \"custom\"\nradius_m = 1e-4\nyoungs_modulus_pa = 3e9\n"
                "poisson_ratio = 0.45\ndensity_kg_m3 = 1300\n[strand]\nlength_m = 0.1\n"
                "elements = 8\nposition_m = [0.06, 0, 0.03]\nroot_tangent = [0, 0, -1]\n"
                "[effects.gravity]\n[[effects.body]]\n" +
                shape + "\n" + moves,
            "mesh.toml"));
        EXPECT_EQ(world.advance(0.3), Status::ok) << world.failure();
        return world.positions();
      };
      const auto mesh = end("shape = \"mesh\"\nmesh_file = \"" + file + "\""),
                 sphere = end("shape = \"sphere\"\nradius_m = 0.05");
      double apart = 0, moved = 0;
      const auto free = end("shape = \"sphere\"\nradius_m = 0.001");
      for (std::size_t i = 0; i < mesh.size(); ++i) {
        apart = std::max(apart, std::abs(mesh[i] - sphere[i]));
        moved = std::max(moved, std::abs(free[i] - sphere[i]));
      }
      EXPECT_LE(apart, 5e-4) << model << moves;
      if (*moves != 0) {
        EXPECT_GE(moved, 5e-3) << model;
      }
    }
  }
}

/// A skin that moves rigidly about the root carries a strand as keyframes do, alone and
/// in a batch. Files keep single precision: corners are 3e-9 m off, directions 1e-7.
TEST(MeshBody, SkinMovesARootAsKeyframesDo) {
  const Vec root{0.05, 0, 0};
  std::string files, rows;
  int number = 0;
  for (const auto& [t, angle, way] :
       {std::array{0.0, 0.0, 0.0}, std::array{0.1, 0.3, 0.01},
        std::array{0.2, -0.1, 0.03}}) {
    TriangleMesh mesh = ball(0.05, 2);
    for (Vec& x : mesh.corner) {
      x = root + rotation({0, 1, 0}, angle) * (x - root) + Vec{0, way, 0};
    }
    const std::string name = "skin_" + std::to_string(number++) + ".obj";
    files += (files.empty() ? "\"" : ", \"") + write_file(name, as_obj(mesh)) + "\"";
    rows += (rows.empty() ? "[" : ", [") + std::to_string(t) + ", 0, " +
            std::to_string(way) + ", 0, " + std::to_string(angle) + "]";
  }
  const auto text = [](const std::string& motion, const std::string& strand) {
    return "title = \"skin\"\nduration_s = 0.3\n[model]\nid = \"super_helix\"\n"
           "[integrator]\nid = \"backward_euler\"\ndt_s = 2e-3\n[material]\n"
           "name = \"hair.caucasian\"\n" +
           strand + "[root]\n" + motion + "[effects.gravity]\n";
  };
  const std::string strand =
      "[strand]\nlength_m = 0.1\nelements = 5\nposition_m = [0.05, 0, 0]\n"
      "root_tangent = [1, 0, 0]\n";
  const std::string skin =
      "motion = \"skin\"\nskin_files = [" + files + "]\nskin_times_s = [0, 0.1, 0.2]\n";
  const auto end = [&](const std::string& motion) {
    World world(parse_scene(text(motion, strand), "skin.toml"));
    EXPECT_EQ(world.advance(0.3), Status::ok) << world.failure();
    return world.positions();
  };
  const auto with_skin = end(skin),
             with_rows =
                 end("motion = \"keyframes\"\naxis = [0, 1, 0]\ncentre_m = "
                     "[0.05, 0, 0]\nkeyframes = [" +
                     rows + "]\n"),
             fixed = end("motion = \"fixed\"\n");
  double apart = 0, moved = 0;
  for (std::size_t i = 0; i < with_skin.size(); ++i) {
    apart = std::max(apart, std::abs(with_skin[i] - with_rows[i]));
    moved = std::max(moved, std::abs(with_skin[i] - fixed[i]));
  }
  EXPECT_LE(apart, 1e-6);
  EXPECT_GE(moved, 1e-2);
  EXPECT_NE(refusal([&] {
              parse_scene(text(skin, strand) +
                              "[effects.body]\nshape = \"plane\"\nmoves = \"head\"\n",
                          "skin.toml");
            }).find("roots that move with a skin"),
            std::string::npos);
}

/// A head that opens its jaw while a cut moves it aside, which gravity does not see: its
/// groom follows as without the cut. Files keep single precision: of coordinates up to
/// 0.5 m 3e-8 m, so triangles of 2 cm turn by 3e-6 rad and tips of 5 cm move by 2e-7 m,
/// at two frames. Steps of 100 ms amplify that less than tenfold.
TEST(MeshBody, SkinCarriesAGroomThroughACut) {
  const Vec away{0.3, -0.2, 0.1};
  const Frame turn = rotation({0, 0, 1}, 1.2);
  const auto scene = [&](const std::string& name, bool cut) {
    std::string files;
    int number = 0;
    for (const double angle : {0.0, 0.1, 0.2, 0.2, 0.3}) {
      TriangleMesh mesh = ball(0.1, 3);
      for (Vec& x : mesh.corner) {
        if (x.z < -0.02) x = rotation({0, 1, 0}, angle) * x;
        if (cut && number > 2) x = turn * x + away;
      }
      files += (number > 0 ? ", \"" : "\"") +
               write_file(name + std::to_string(number) + ".obj", as_obj(mesh)) + "\"";
      ++number;
    }
    return parse_scene(
        "title = \"jaw\"\nduration_s = 0.2\n[model]\nid = \"super_helix\"\n"
        "[integrator]\nid = \"backward_euler\"\ndt_s = 2e-3\n[material]\n"
        "name = \"hair.caucasian\"\n[groom]\ncount = 300\nlength_m = 0.05\n"
        "elements = 4\nhalf_axes_m = [0.1, 0.1, 0.1]\ncap_angle_rad = 3\n[root]\n"
        "motion = \"skin\"\nskin_files = [" +
            files + "]\nskin_times_s = [0, 0.05, 0.1, 0.1, 0.15]\n[effects.gravity]\n",
        "jaw.toml");
  };
  std::vector<double> ends[2];
  for (const bool cut : {false, true}) {
    HeadRun run(make_head(scene(cut ? "cut" : "jaw", cut), {}, 2), 2);
    for (int k = 0; k < 4; ++k) {
      run.step(0.05 * k, 0.05);
      EXPECT_TRUE(run.lost().empty());
    }
    run.positions(0.2, ends[cut ? 1 : 0]);
  }
  ASSERT_EQ(ends[0].size(), 300u * 3 * 5);
  for (std::size_t i = 0; i < ends[0].size(); i += 3) {
    const Vec expected = turn * load3(&ends[0][i]) + away;
    EXPECT_LE(norm(load3(&ends[1][i]) - expected), 4e-6);
  }
}

}  // namespace tress::test_mesh_body
