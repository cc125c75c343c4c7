#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "simulation/gradient/scene_gradient.h"
#include "simulation/run/world.h"
#include "simulation/scene_text/write_scene.h"
#include "tests/harness/toy_process.h"
#include "tests/support/refusal.h"

namespace tress::test_scene_gradient {

using namespace simulation;
using testing_support::refusal;

/// A curled hair in wind over a plane that it does not reach.
std::string scene_text(
    const std::string& gradient,
    const std::string& integrator = "dt_s = 0.002\nnewton_tolerance = 1e-13",
    const std::string& strand = "[strand]") {
  return "title = \"t\"\nduration_s = 0.1\nframes_per_s = 20\n[integrator]\nid = "
         "\"tr_bdf2\"\n" +
         integrator + "\n[material]\ninternal_friction_kg_m3_s = 1e-10\n" + strand +
         "\nelements = 5\nshape = \"helix\"\ninitial = \"straight\"\n"
         "[root]\nmotion = \"swing\"\namplitude_m = 0.01\nfrequency_hz = 3\n"
         "[effects.gravity]\n[effects.linear_drag]\ndrag_kg_m_s = 1e-4\n"
         "[effects.wind]\nvelocity_m_s = [1, 0.5, 0]\n" +
         gradient;
}

/// By central differences of order 4 of the scene's own gradient runs, whose start is
/// that of the gradient.
std::vector<double> difference(const Scene& scene, const SceneParameter& by) {
  constexpr double e = 1e-3;
  const auto at = [&](double s) {
    Scene changed = scene;
    by.change(changed, s);
    return scene_gradient(changed).strands.front().points.back();
  };
  const auto p1 = at(e), m1 = at(-e), p2 = at(2 * e), m2 = at(-2 * e);
  std::vector<double> d(p1.size());
  for (std::size_t i = 0; i < d.size(); ++i) {
    d[i] = (8 * (p1[i] - m1[i]) - (p2[i] - m2[i])) / (12 * e * by.measure);
  }
  return d;
}

void expect_differences(const std::string& text) {
  const Scene scene = parse_scene(text, "s.toml");
  const SceneGradient found = scene_gradient(scene);
  const StrandGradient& strand = found.strands.front();
  ASSERT_EQ(strand.unfinished, "");
  ASSERT_EQ(strand.points.size(), scene.last_frame() + 1);
  for (std::size_t k = 0; k < found.parameters.size(); ++k) {
    const std::vector<double> by_runs = difference(scene, found.parameters[k]);
    double worst = 0, most = 0;
    for (std::size_t i = 0; i < by_runs.size(); ++i) {
      worst = std::max(worst, std::abs(strand.by[k].back()[i] - by_runs[i]));
      most = std::max(most, std::abs(by_runs[i]));
    }
    EXPECT_GT(most * found.parameters[k].measure, 1e-8) << found.parameters[k].name;
    // Differences see Newton's tolerance, 1e-10 of the typical sizes, over e.
    EXPECT_LT(worst, 1e-6 * most) << found.parameters[k].name;
  }
}

TEST(SceneGradient, IsThatOfDifferencesForEveryKindOfParameter) {
  expect_differences(scene_text(
      "[gradient]\nby = [\"youngs_modulus_pa\", \"shear_modulus_pa\", \"density_kg_m3\", "
      "\"radius_m\", \"internal_friction_kg_m3_s\", \"natural_curvature_per_m\", "
      "\"natural_twist_per_m.2\", \"initial_curvature2_per_m\", \"root_angle_rad.y\", "
      "\"root_position_m.z\", \"root.amplitude_m\", \"linear_drag.drag_kg_m_s\", "
      "\"wind.velocity_m_s.y\", \"gravity.gravity_m_s2.z\"]\n"));
}

TEST(SceneGradient, OfAFreeStrandIsThatOfDifferencesByItsFirstVelocity) {
  std::string text = scene_text(
      "[gradient]\nby = [\"root.velocity_m_s.x\", \"root.spin_rad_s.y\", "
      "\"linear_drag.drag_kg_m_s\"]\n");
  // In its natural shape: from a straight one it whips.
  const std::string straight = "initial = \"straight\"\n";
  text.replace(text.find(straight), straight.size(), "");
  const std::string swing = "motion = \"swing\"\namplitude_m = 0.01\nfrequency_hz = 3\n";
  text.replace(
      text.find(swing), swing.size(),
      "motion = \"free\"\nvelocity_m_s = [0.2, 0, 0.1]\nspin_rad_s = [0, 3, 1]\n");
  expect_differences(text);
}

TEST(SceneGradient, OfAStrandOfEachElementIsThatOfAll) {
  const Scene scene =
      parse_scene(scene_text("[gradient]\nby = [\"natural_curvature_per_m\", "
                             "\"natural_curvature_per_m.each\"]\n"),
                  "s.toml");
  const SceneGradient found = scene_gradient(scene);
  ASSERT_EQ(found.parameters.size(), 6u);
  EXPECT_EQ(found.parameters[3].name, "natural_curvature_per_m.2");
  EXPECT_TRUE(found.damped);
  const auto& by = found.strands.front().by;
  double worst = 0, most = 0;
  for (std::size_t i = 0; i < by[0].back().size(); ++i) {
    double sum = 0;
    for (std::size_t k = 1; k < by.size(); ++k) sum += by[k].back()[i];
    worst = std::max(worst, std::abs(sum - by[0].back()[i]));
    most = std::max(most, std::abs(sum));
  }
  EXPECT_LT(worst, 1e-8 * most);
}

TEST(SceneGradient, OfEachElementHasThoseOfTheLongestStrand) {
  const Scene scene =
      parse_scene(scene_text("[[strand]]\nelements = 7\nposition_m = [0, 0.01, "
                             "0]\n[gradient]\nby = [\"natural_curvature_per_m.each\", "
                             "\"natural_twist_per_m.6\"]\n",
                             "dt_s = 0.002\nnewton_tolerance = 1e-13", "[[strand]]"),
                  "s.toml");
  const SceneGradient found = scene_gradient(scene);
  ASSERT_EQ(found.parameters.size(), 8u);
  const auto tip = [&](std::size_t strand, std::size_t k) {
    return std::abs(found.strands[strand].by[k].back().back());
  };
  EXPECT_LT(tip(0, 6), 1e-9 * tip(1, 6));  // rounding
  EXPECT_EQ(found.parameters[7].value, 0);
}

/// Largest difference of the derivatives of the tip at the last frame over the largest.
/// Forward derivatives difference the residual over 1e-5 of typical rates: of its terms
/// 1e-11 remain as rounding. Initial curvatures of the second mode move the tip by so
/// little that this is 3e-7 of their derivative; all others agree to 1e-7.
void expect_same_tip(const SceneGradient& found, const SceneGradient& expected) {
  const auto &one = found.strands.front(), &other = expected.strands.front();
  ASSERT_EQ(one.unfinished, "");
  ASSERT_EQ(one.by.size(), other.by.size());
  for (std::size_t k = 0; k < one.by.size(); ++k) {
    double apart = 0, most = 0;
    for (std::size_t i = other.by[k].back().size() - 3; i < other.by[k].back().size();
         ++i) {
      const double expected_entry = other.by[k].back()[i];
      apart = std::max(apart, std::abs(one.by[k].back()[i] - expected_entry));
      most = std::max(most, std::abs(expected_entry));
    }
    EXPECT_GT(most * found.parameters[k].measure, 1e-8) << found.parameters[k].name;
    const bool faint = found.parameters[k].name == "initial_curvature2_per_m";
    EXPECT_LT(apart, (faint ? 1e-6 : 1e-7) * most) << found.parameters[k].name;
  }
}

TEST(SceneGradient, ByTheAdjointIsThatForwardForEveryKindOfParameter) {
  for (const char* integrator :
       {"dt_s = 0.002\nnewton_tolerance = 1e-13", "position_tol_rel = 1e-3"}) {
    const auto way = [&](const std::string& word) {
      return scene_gradient(parse_scene(
          scene_text("[gradient]\nby = [\"youngs_modulus_pa\", \"density_kg_m3\", "
                     "\"radius_m\", \"internal_friction_kg_m3_s\", "
                     "\"natural_curvature_per_m\", \"natural_twist_per_m.2\", "
                     "\"initial_curvature2_per_m\", \"root_angle_rad.y\", "
                     "\"root_position_m.z\", \"root.amplitude_m\", "
                     "\"linear_drag.drag_kg_m_s\", \"wind.velocity_m_s.y\"]\nway = \"" +
                         word + "\"\n",
                     integrator),
          "s.toml"));
    };
    const SceneGradient found = way("adjoint");
    EXPECT_TRUE(found.strands.front().adjoint);
    expect_same_tip(found, way("forward"));
  }
}

// Parameters of what does not act at the start of a run.
TEST(SceneGradient, SeesWhatActsLater) {
  const auto text = [](const std::string& word) {
    return scene_text(
        "[effects.tether]\nstiffness_n_m = 1e-5\ntarget_m = [0.05, 0, 0]\nt_on_s = "
        "0.05\n[gradient]\nby = [\"tether.stiffness_n_m\"]\nway = \"" +
        word + "\"\n");
  };
  expect_differences(text("forward"));
  expect_same_tip(scene_gradient(parse_scene(text("adjoint"), "s.toml")),
                  scene_gradient(parse_scene(text("forward"), "s.toml")));
}

// 3 numbers by 15 parameters. An edge of der that turns by 60 degrees moves its frame.
TEST(SceneGradient, TakesTheAdjointWhereItIsExpectedToCostLess) {
  const auto found = [](const std::string& model, const std::string& more) {
    return scene_gradient(parse_scene(
        "title = \"t\"\nduration_s = 0.2\nframes_per_s = 5\n[integrator]\nid = "
        "\"tr_bdf2\"\ndt_s = "
        "0.004\nnewton_tolerance = 1e-13\n[model]\nid = \"" +
            model +
            "\"\n[material]\ninternal_friction_kg_m3_s = 1e-10\n[strand]\nelements = "
            "5\nshape = \"helix\"\ninitial = "
            "\"straight\"\n[effects.gravity]\n[effects.linear_drag]\ndrag_kg_m_s = "
            "1e-4\n" +
            "[gradient]\nby = [\"natural_curvature_per_m.each\", "
            "\"natural_curvature2_per_m.each\", \"natural_twist_per_m.each\"]\nof = "
            "\"last_tip\"\n" +
            more,
        "s.toml"));
  };
  const SceneGradient helix = found("super_helix", ""), der = found("der", "");
  EXPECT_TRUE(helix.strands.front().adjoint);
  EXPECT_FALSE(found("super_helix", "way = \"forward\"\n").strands.front().adjoint);
  EXPECT_FALSE(der.strands.front().adjoint);
  EXPECT_EQ(der.strands.front().unfinished, "");
  const SceneGradient refused = found("der", "way = \"adjoint\"\n");
  EXPECT_NE(refused.strands.front().unfinished.find("forward in time"),
            std::string::npos);
}

class SceneGradientOf : public testing::TestWithParam<const char*> {};

// J of the frozen run is within 3 tolerances of that of a run with a hundredth of the
// tolerance, and its points within a tenth of one from those of the run with control.
TEST_P(SceneGradientOf, ARunWithAToleranceIsThatWithItsStepsFrozen) {
  const auto at = [](double tolerance) {
    std::string text = scene_text(
        "[gradient]\nby = [\"youngs_modulus_pa\", "
        "\"linear_drag.drag_kg_m_s\"]\nstart = \"as_run\"\n",
        "position_tol_rel = " + number_text(tolerance));
    text.replace(text.find("tr_bdf2"), std::string("tr_bdf2").size(), GetParam());
    return scene_gradient(parse_scene(text, "s.toml"));
  };
  const SceneGradient exact = at(1e-6);
  for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
    const SceneGradient found = at(tolerance);
    const StrandGradient &strand = found.strands.front(), &other = exact.strands.front();
    EXPECT_GT(strand.moved, 0) << tolerance;
    // The algorithmic acceleration of frozen steps is not that of steps under control.
    const bool algorithmic = GetParam() == std::string("generalized_alpha");
    if (algorithmic && tolerance == 1e-2) {
      EXPECT_NE(strand.unfinished.find("steps frozen"), std::string::npos);
      continue;
    }
    EXPECT_EQ(strand.unfinished, "");
    EXPECT_LT(strand.moved, (algorithmic ? 1 : 0.1) * tolerance) << tolerance;
    for (std::size_t k = 0; k < strand.by.size(); ++k) {
      double worst = 0, most = 0;
      for (std::size_t i = 0; i < strand.by[k].back().size(); ++i) {
        const double expected = other.by[k].back()[i];
        worst = std::max(worst, std::abs(strand.by[k].back()[i] - expected));
        most = std::max(most, std::abs(expected));
      }
      EXPECT_LT(worst, 3 * tolerance * most) << tolerance;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, SceneGradientOf,
                         testing::Values("tr_bdf2", "esdirk43", "bdf2",
                                         "generalized_alpha"),
                         [](const auto& c) { return std::string(c.param); });

/// One coordinate: vectors of the method's state are as long as its single numbers.
TEST(SceneGradient, OfOneCoordinateIsTheSameForwardAndBackward) {
  for (const char* method : {"bdf2", "generalized_alpha", "tr_bdf2", "backward_euler"}) {
    const auto by = [&](const std::string& way) {
      return scene_gradient(
                 parse_scene("title = \"one\"\nduration_s = 0.3\nframes_per_s = 20\n"
                             "[model]\nid = \"super_helix\"\nmodes = "
                             "\"bend_planar\"\n[integrator]\nid = \"" +
                                 std::string(method) +
                                 "\"\ndt_s = 0.005\nnewton_tolerance = 1e-12\n"
                                 "[strand]\nelements = 1\n[root]\n"
                                 "[effects.gravity]\n[effects.linear_drag]\n"
                                 "[gradient]\nby = [\"youngs_modulus_pa\"]\nway = \"" +
                                 way + "\"\n",
                             "one.toml"))
          .strands.front()
          .by[0]
          .back();
    };
    const std::vector<double> forward = by("forward"), adjoint = by("adjoint");
    ASSERT_EQ(forward.size(), adjoint.size());
    for (std::size_t i = 0; i < forward.size(); ++i) {
      // Both solve the same linear equations, to rounding and Newton's tolerance.
      EXPECT_NEAR(adjoint[i], forward[i], 1e-7 * std::abs(forward.back())) << method;
    }
  }
}

std::string refused(const std::string& by) {
  return refusal([&] { parse_scene(scene_text("[gradient]\n" + by), "s.toml"); });
}

TEST(SceneGradient, NamesWhatIsNoParameterAndWhere) {
  EXPECT_EQ(refused("by = [\"youngs_moduls_pa\"]\n").substr(0, 51),
            "unknown parameter 'youngs_moduls_pa' (s.toml:24:6):");
  EXPECT_NE(refused("by = [\"youngs_moduls_pa\"]\n").find("youngs_modulus_pa'?"),
            std::string::npos);
  const std::string listed = refused("by = [\"zzzzzz\"]\n");
  EXPECT_NE(listed.find("root.amplitude_m"), std::string::npos) << listed;
  EXPECT_NE(refused("by = [\"poisson_ratio\"]\n").find("give shear_modulus_pa"),
            std::string::npos);
  EXPECT_NE(refused("by = [\"initial_velocity_m_s\"]\n").find("starts at rest"),
            std::string::npos);
  EXPECT_NE(refused("by = [\"natural_twist_per_m.5\"]\n").find("elements 0 to 4"),
            std::string::npos);
  EXPECT_NE(refused("by = [\"natural_twist_per_m.\"]\n").find("give .each"),
            std::string::npos);
  EXPECT_NE(refused("by = [\"root_angle_rad\"]\n").find("give root_angle_rad.x"),
            std::string::npos);
  EXPECT_NE(refused("by = [\"root.speed_m_s\"]\n").find("does not use it"),
            std::string::npos);
  EXPECT_NE(refused("by = [\"wind.velocity_m_s\"]\n").find(".x, .y or .z"),
            std::string::npos);
  for (const std::string of : {"wind.velocity_m_s", "root_angle_rad"}) {
    for (const char* wrong : {".w", ".X", ".0", ".x.y"}) {
      const std::string answer = refused("by = [\"" + of + wrong + "\"]\n");
      EXPECT_NE(answer.find(of + " has the components x, y and z (s.toml:24:6): give " +
                            of + ".x, .y or .z"),
                std::string::npos)
          << answer;
    }
  }
  EXPECT_NE(refused("by = [\"linear_drag.drag_kg_m_s.w\"]\n")
                .find("linear_drag.drag_kg_m_s is one number"),
            std::string::npos);
  EXPECT_NE(refused("by = [\"wind.frequency_hz\"]\n")
                .find("profile = \"constant\" does not use it"),
            std::string::npos);
  EXPECT_NE(
      refused("by = [\"wind.c_normal\"]\n").find("law = \"linear\" does not use it"),
      std::string::npos);
  EXPECT_EQ(listed.find("wind.frequency_hz"), std::string::npos) << listed;
  EXPECT_NE(refused("by = []\n").find("names nothing"), std::string::npos);
  EXPECT_NE(refused("by = [\"radius_m\", \"radius_m\"]\n").find("twice"),
            std::string::npos);
  EXPECT_NE(refused("by = \"radius_m\"\n").find("expected a list of strings"),
            std::string::npos);
  EXPECT_NE(refused("by = [1]\n").find("expected a list of strings"), std::string::npos);
  EXPECT_NE(refused("off = \"tip\"\n").find("unknown key 'off'"), std::string::npos);
}

// Runs are staircases in numbers that are rounded to points or samples.
TEST(SceneGradient, IsRefusedByNumbersThatAreRounded) {
  const auto reason = [](const std::string& by) {
    const std::string effect = by.substr(0, by.find('.'));
    return refused("by = [\"" + by + "\"]\n[effects." + effect + "]\n");
  };
  EXPECT_NE(reason("tether.at").find("holds one point of the model"), std::string::npos);
  EXPECT_NE(reason("self_contact.separation_m").find("rounds it to elements"),
            std::string::npos);
  EXPECT_NE(reason("self_contact.inner_radius_m").find("are a whole number"),
            std::string::npos);
  const std::string listed = refused("by = [\"zzzzzz\"]\n[effects.tether]\n");
  EXPECT_NE(listed.find("tether.soft_m"), std::string::npos) << listed;
  EXPECT_EQ(listed.find("tether.at,"), std::string::npos) << listed;
}

// Units are those of the names, whatever else is in parentheses.
TEST(SceneGradient, HasTheUnitsOfItsParameters) {
  const std::string effects = "[effects.tether]\n[effects.distributed_load]\nto = 0.83\n";
  const Scene scene = parse_scene(scene_text(effects), "s.toml");
  const auto unit = [&](const std::string& name) {
    return gradient_parameters(scene, std::vector<std::string>{name}, "by").front().unit;
  };
  EXPECT_EQ(unit("root.amplitude_m"), "m");
  EXPECT_EQ(unit("root.frequency_hz"), "Hz");
  EXPECT_EQ(unit("root.direction.x"), "1");
  EXPECT_EQ(unit("linear_drag.drag_kg_m_s"), "kg/(m s)");
  EXPECT_EQ(unit("tether.target_m.x"), "m");
  EXPECT_EQ(unit("wind.velocity_m_s.x"), "m/s");
  EXPECT_EQ(unit("gravity.gravity_m_s2.z"), "m/s^2");
  EXPECT_EQ(unit("distributed_load.to"), "1");
}

// The load ends at 0.83 of the length, 1 is the end of the range.
TEST(SceneGradient, OfANumberNearTheEndOfItsRangeIsThatOfDifferences) {
  const auto text = [](const std::string& to) {
    return scene_text("[effects.distributed_load]\nforce_n_per_m = [0, 1e-4, 0]\nto = " +
                      to + "\n[gradient]\nby = [\"distributed_load.to\"]\n");
  };
  const Scene near = parse_scene(text("0.83"), "s.toml");
  const StrandGradient found = scene_gradient(near).strands.front();
  const auto y = [&](const char* to) {
    const Scene scene = parse_scene(text(to), "s.toml");
    return scene_gradient(scene).strands.front().points.back().end()[-2];
  };
  // The load is piecewise linear in its end, and the strand almost: 1e-4 of it.
  const double d = (y("0.831") - y("0.829")) / 0.002;
  EXPECT_GT(std::abs(d), 1e-5);
  EXPECT_NEAR(found.by[0].back().end()[-2], d, 1e-3 * std::abs(d));
  EXPECT_NE(refusal([&] {
              parse_scene(text("1.0"), "s.toml");
            }).find("1 is at the end of its range, 0 to 1"),
            std::string::npos);
}

TEST(SceneGradient, IsRefusedWhereARunHasNone) {
  const auto checked = [](std::string text) {
    return refusal([&] { check_gradient(parse_scene(text, "s.toml")); });
  };
  const std::string by = "[gradient]\nby = [\"radius_m\"]\n";
  EXPECT_EQ(checked(scene_text(by)), "");
  EXPECT_NE(checked(scene_text("")).find("has no [gradient]"), std::string::npos);
  std::string other = scene_text(by);
  other.replace(other.find("tr_bdf2"), 7, "linearly_implicit_euler");
  EXPECT_NE(checked(other).find("are taken (s.toml:23:1): use backward_euler"),
            std::string::npos)
      << checked(other);
  EXPECT_NE(checked("rest = \"inverse\"\n" + scene_text(by))
                .find("leave out rest = \"inverse\""),
            std::string::npos);
  const std::string body = "[[effects.body]]\nfriction_law = \"exact\"\n";
  EXPECT_NE(checked(scene_text(body + by)).find("friction_law = \"regularised\""),
            std::string::npos)
      << checked(scene_text(body + by));
  const std::string rotors = "[model]\nrotary_inertia = \"off\"\n";
  EXPECT_NE(checked(scene_text(rotors + by)).find("use rotary_inertia = \"on\""),
            std::string::npos)
      << checked(scene_text(rotors + by));
  const std::string touch =
      checked(scene_text("[effects.strand_interaction]\n[effects.control_mesh]\n" + by));
  EXPECT_NE(touch.find("leave out [effects."), std::string::npos) << touch;
}

// The remedies of refusals are settings that the scene reader accepts.
TEST(SceneGradient, RemediesAreSettingsOfAScene) {
  const std::string by = "[gradient]\nby = [\"radius_m\"]\n";
  for (const std::string more : {"[[effects.body]]\nfriction_law = \"regularised\"\n",
                                 "[model]\nrotary_inertia = \"on\"\n"}) {
    EXPECT_EQ(refusal([&] { check_gradient(parse_scene(scene_text(more + by), "s")); }),
              "");
  }
}

TEST(SceneGradient, IsKeptByASceneThatIsWritten) {
  const Scene scene = parse_scene(
      scene_text(
          "[gradient]\nby = [\"radius_m\", \"root_angle_rad.z\"]\nof = \"points\"\n"),
      "s.toml");
  const Scene again = parse_scene(simulation::scene_text(scene), "again.toml");
  EXPECT_EQ(gradient_parameters(again)[1].name, "root_angle_rad.z");
  EXPECT_EQ(simulation::scene_text(again), simulation::scene_text(scene));
}

TEST(SimulateGradient, RefusesATableThatIsTooLargeBeforeItRuns) {
  Toy simulate;
  std::string text = scene_text(
      "[gradient]\nby = [\"natural_curvature_per_m.each\", "
      "\"natural_curvature2_per_m.each\", \"natural_twist_per_m.each\", "
      "\"initial_curvature_per_m.each\", \"initial_curvature2_per_m.each\", "
      "\"initial_twist_per_m.each\"]\nof = \"points\"\n");
  const std::string few = "frames_per_s = 20\n";
  text.replace(text.find(few), few.size(), "frames_per_s = 400000\n");
  simulate.write("s.toml", text);
  const Toy::Result run = simulate.run("s.toml --gradient --out out --progress none");
  EXPECT_EQ(run.code, 2);
  EXPECT_EQ(run.error_lines(), 1) << run.err;
  // 40001 frames, 6 points, 3 components, 30 parameters.
  EXPECT_NE(run.err.find("2.2e+07 rows, about 2.2 GB (s.toml:23:1): set of = "
                         "\"last_tip\""),
            std::string::npos)
      << run.err;
}

// Richardson's estimates: 2 times the change of methods of order 1, 4/3 times that of
// methods of order 2. The column has 3 digits.
TEST(SimulateGradient, EstimatesTheErrorInTimeByTheOrderOfTheMethod) {
  for (const auto& [method, factor] :
       {std::pair("backward_euler", 2.0), {"tr_bdf2", 4.0 / 3}}) {
    Toy simulate;
    std::string text = scene_text("[gradient]\nby = [\"linear_drag.drag_kg_m_s\"]\n");
    text.replace(text.find("tr_bdf2"), 7, method);
    simulate.write("s.toml", text);
    const Toy::Result run = simulate.run("s.toml --gradient --out out --progress none");
    EXPECT_EQ(run.code, 0) << run.err;
    EXPECT_NE(run.err.find("; estimated error in time "), std::string::npos) << run.err;
    const Scene scene = parse_scene(text, "s.toml");
    const auto x_of_last_tip = [&](int parts) {
      const StrandGradient found = scene_gradient(scene, parts).strands.front();
      return found.by[0].back().end()[-3];
    };
    const double change = std::abs(x_of_last_tip(1) - x_of_last_tip(2));
    const std::string table = simulate.read("out/s.gradient.csv");
    const std::size_t row = table.find("0,5,0.1,x,");
    ASSERT_NE(row, std::string::npos);
    std::istringstream entries(table.substr(row));
    std::string entry;
    for (int i = 0; i < 9; ++i) std::getline(entries, entry, ',');
    EXPECT_NEAR(std::stod(entry), factor * change, 6e-3 * factor * change) << method;
  }
}

// An edge of der moves its frame, back through which there is no adjoint.
TEST(SimulateGradient, MarksWhereARunEndsEarly) {
  Toy simulate;
  std::string text =
      scene_text("[gradient]\nby = [\"youngs_modulus_pa\"]\nway = \"adjoint\"\n",
                 "dt_s = 0.004\nnewton_tolerance = 1e-13\n[model]\nid = \"der\"\n");
  text.replace(text.find("duration_s = 0.1"), 16, "duration_s = 0.4");
  simulate.write("s.toml", text);
  const Toy::Result run = simulate.run("s.toml --gradient --out out --progress none");
  EXPECT_EQ(run.code, 3) << run.err;
  EXPECT_NE(run.err.find("not finished"), std::string::npos) << run.err;
  const std::string table = simulate.read("out/s.gradient.csv");
  EXPECT_TRUE(table.ends_with(",unfinished\n")) << table;
}

TEST(SimulateGradient, StatesWhatStrandsOfOtherMaterialsDo) {
  Toy simulate;
  std::string text =
      scene_text("[gradient]\nby = [\"youngs_modulus_pa\", \"wind.velocity_m_s.y\"]\n");
  const auto said = [&] {
    simulate.write("s.toml", text);
    const Toy::Result run = simulate.run("s.toml --gradient --out out --progress none");
    EXPECT_EQ(run.code, 0) << run.err;
    return run.err.find("per unit of the number of strand 0") != std::string::npos;
  };
  EXPECT_FALSE(said());
  text.replace(text.find("[strand]"), 8,
               "[[strand]]\nelements = 2\nmaterial = {youngs_modulus_pa = "
               "1e9}\n[[strand]]");
  EXPECT_TRUE(said());
}

TEST(SimulateGradient, WritesTheTableAndSaysWhatAPercentDoes) {
  Toy simulate;
  const std::string text =
      scene_text("[gradient]\nby = [\"youngs_modulus_pa\", \"natural_twist_per_m\"]\n");
  simulate.write("s.toml", text);
  const Toy::Result run = simulate.run("s.toml --gradient --out out --progress none");
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.err.find("1 % of youngs_modulus_pa moves the tip by"), std::string::npos)
      << run.err;
  std::istringstream table(simulate.read("out/s.gradient.csv"));
  std::string line;
  std::getline(table, line);
  EXPECT_EQ(
      line,
      "strand,point,time_s,component,by,unit,derivative,relative,time_error,status");
  int rows = 0;
  while (std::getline(table, line)) {
    ++rows;
    EXPECT_EQ(std::ranges::count(line, ','), 9) << line;
    EXPECT_TRUE(line.ends_with(",ok")) << line;
  }
  EXPECT_EQ(rows, 3 * 3 * 2);  // frames, components, parameters
  EXPECT_EQ(count_of_derivatives(parse_scene(text, "s.toml")), rows);
  const Toy::Result refused = simulate.run("s.toml --gradient --as batch --out other");
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.err.find("--gradient cannot be combined with --as batch"),
            std::string::npos)
      << refused.err;
}

}  // namespace tress::test_scene_gradient
