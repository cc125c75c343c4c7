// Scenes with [effects.control_mesh]: every strand model, snapshots, threads, refusals.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "contract/input_error.h"
#include "simulation/run/readout.h"
#include "simulation/run/world.h"

namespace tress::test_control_mesh_scene {

using namespace simulation;

/// Seven strands around one, 1 cm apart, along x, with wind that parts them.
std::string text(
    const std::string& model, const std::string& mesh,
    const std::string& integrator = "id = \"backward_euler\"\ndt_s = 0.002") {
  std::string strands;
  for (const char* const root :
       {"0, 0, 0", "0, 0.01, 0", "0, 0.005, 0.0087", "0, -0.005, 0.0087", "0, -0.01, 0",
        "0, -0.005, -0.0087", "0, 0.005, -0.0087"}) {
    strands +=
        "[[strand]]\nlength_m = 0.1\nelements = 8\nroot_tangent = [1, 0, 0]\n"
        "position_m = [" +
        std::string(root) + "]\n";
  }
  return "title = \"wisp\"\nduration_s = 0.1\n[model]\nid = \"" + model +
         "\"\n[integrator]\n" + integrator + "\n[material]\nname = \"hair.asian\"\n" +
         strands +
         "[root]\nmotion = \"fixed\"\n[effects.gravity]\n[effects.linear_drag]\n"
         "drag_kg_m_s = 2e-5\n[effects.wind]\nprofile = \"gusts\"\nvelocity_m_s = [0, 2, "
         "0]\n" +
         mesh;
}

Scene wisp(const std::string& model, const std::string& mesh) {
  return parse_scene(text(model, "[effects.control_mesh]\n" + mesh), "wisp.toml");
}

double share_of_channel(const Scene& scene, World& world) {
  Readout readout(scene, world);
  const Frame3d frame = readout.read(world);
  const std::size_t points = readout.points();
  double most = 0;
  for (std::size_t c = 0; c < readout.channels().size(); ++c) {
    if (readout.channels()[c].name != "load control_mesh") continue;
    for (std::size_t i = 0; i < points; ++i) {
      most = std::max(most, static_cast<double>(frame.channels[c * points + i]));
    }
  }
  return most;
}

/// Links are at rest where strands start, and hold them together afterwards.
TEST(ControlMeshScene, EveryStrandModelIsTied) {
  int models = 0;
  for (const ModelEntry& entry : model_catalogue()) {
    if (entry.on_strand == nullptr || entry.id == "kirchhoff_nodal") continue;
    const bool constrained =
        entry.id == "inextensible_strand" || entry.id == "dynamic_spline";
    const std::string method =
        std::string(constrained ? "formulation = \"index3\"\n" : "") +
        "id = \"backward_euler\"\ndt_s = 0.002";
    const auto spread = [&](const std::string& mesh) {
      const Scene scene =
          parse_scene(text(std::string(entry.id), mesh, method), "wisp.toml");
      World world(scene);
      if (world.mesh() != nullptr) {
        EXPECT_EQ(world.mesh()->energy(), 0) << entry.id;
        EXPECT_EQ(world.mesh()->mesh().links.size(), 12U * 7) << entry.id;
        // N/m, in single precision; links 1 mm longer pull 3 x 1e-5.
        EXPECT_LT(share_of_channel(scene, world), 1e-9) << entry.id;
      }
      EXPECT_EQ(world.advance(0.1), Status::ok) << entry.id << world.failure();
      double far = 0;
      const std::vector<double>& x = world.positions();
      for (std::size_t k = 1; k < 7; ++k) {
        const Vec apart = load3(&x[27 * k + 24]) - load3(&x[24]);
        far = std::max(far, std::abs(norm(apart) - 0.01));
      }
      return far;
    };
    ++models;
    EXPECT_LT(spread("[effects.control_mesh]\nlink_stiffness_n_m2 = 1\n"), 3e-3)
        << entry.id;
  }
  EXPECT_GE(models, 7);
}

TEST(ControlMeshScene, ContinuesASnapshotBitByBitOnAnyThreads) {
  for (const char* const model : {"super_helix", "der"}) {
    const Scene made = wisp(model, "break_m = 1e-4\nstiffness_n_m2 = 0.1\n");
    World whole(made), half(made, 2), rest(made, 3);
    for (int i = 1; i <= 10; ++i) {
      ASSERT_EQ(whole.advance(0.01 * i), Status::ok) << whole.failure();
      if (i <= 5) {
        ASSERT_EQ(half.advance(0.01 * i), Status::ok);
      }
      if (i == 5) {
        EXPECT_GT(whole.mesh()->broken(), 0U);
        const Snapshot middle = half.snapshot();
        EXPECT_EQ(middle.couplings.back().size(), half.mesh()->broken());
        whole.restore(whole.snapshot());
        rest.restore(middle);
      }
      if (i > 5) {
        ASSERT_EQ(rest.advance(0.01 * i), Status::ok);
      }
    }
    EXPECT_LT(whole.mesh()->broken(), whole.mesh()->mesh().links.size());
    EXPECT_EQ(whole.positions(), rest.positions()) << model;
    EXPECT_EQ(whole.mesh()->memory(), rest.mesh()->memory()) << model;
  }
}

TEST(ControlMeshScene, TheSeriesCountsBrokenLinks) {
  const Scene scene = wisp("super_helix", "break_m = 1e-4\n");
  World world(scene);
  Readout readout(scene, world);
  ASSERT_EQ(world.advance(0.1), Status::ok) << world.failure();
  const Frame3d frame = readout.read(world);
  bool found = false;
  for (std::size_t i = 0; i < readout.series().size(); ++i) {
    if (readout.series()[i].name != "broken_links") continue;
    found = true;
    EXPECT_GT(frame.series[i], 0);
    EXPECT_EQ(frame.series[i], static_cast<double>(world.mesh()->broken()));
    EXPECT_EQ(frame.series[i + 2], world.mesh()->energy());
  }
  EXPECT_TRUE(found);
  EXPECT_EQ(frame.series.size(), readout.series().size());
}

std::string refusal(const std::string& scene) {
  try {
    parse_scene(scene, "wisp.toml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

TEST(ControlMeshScene, WhatItCannotDoIsRefusedWithTheReason) {
  const std::string mesh = "[effects.control_mesh]\n";
  EXPECT_EQ(refusal(text("super_helix", mesh)), "none");
  EXPECT_THAT(
      refusal(text("super_helix", mesh, "id = \"tr_bdf2\"\nposition_tol_rel = 1e-3")),
      testing::HasSubstr("found once a step"));
  EXPECT_THAT(
      refusal(text("mass_spring",
                   mesh + "[effects.strand_interaction]\ncoupling = \"monolithic\"\n")),
      testing::HasSubstr("one system"));
  EXPECT_THAT(refusal(text("super_helix", mesh + "outer_radius_m = 1e-3\n")),
              testing::HasSubstr("outer_radius_m"));
  EXPECT_THAT(refusal("title = \"t\"\n[strand]\nelements = 1\n" + mesh),
              testing::HasSubstr("at least two segments"));
}

}  // namespace tress::test_control_mesh_scene
