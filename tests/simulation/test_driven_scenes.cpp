// Scenes with [[effects.point_moment]] and [[effects.natural_shape]]: circular arcs,
// twist, batches, and what is refused.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "simulation/rest/supported_start.h"
#include "simulation/run/readout.h"
#include "simulation/run/world.h"
#include "simulation/scene/support_table.h"
#include "simulation/scene_text/write_scene.h"
#include "tests/support/refusal.h"
#include "tests/support/small_motion.h"

namespace tress::test_driven_scenes {

using namespace simulation;
using testing_support::refusal;
using testing_support::Start;

constexpr double length = 0.1, radius = 1e-4, modulus = 3e9, poisson = 0.45;
const double bending = modulus * std::numbers::pi / 4 * std::pow(radius, 4);
const double twisting = bending / (1 + poisson);

struct Text {
  std::string model = "id = \"super_helix\"";
  std::string integrator = "id = \"tr_bdf2\"\ndt_s = 2e-3";
  std::string drive, duration = "1", elements = "20", rest, density = "1300",
                     friction = "1e-8", top;
};

Scene scene_of(const Text& text) {
  const bool constrained = text.model.find("dynamic_spline") != std::string::npos;
  return parse_scene(
      "title = \"driven\"\nduration_s = " + text.duration + "\n" + text.top +
          "[model]\n" + text.model + "\n[integrator]\n" + text.integrator +
          (constrained ? "\nformulation = \"index3\"" : "") +
          "\n[material]\nname = \"custom\"\nradius_m = 1e-4\nyoungs_modulus_pa = 3e9\n"
          "poisson_ratio = 0.45\ndensity_kg_m3 = " +
          text.density + "\ninternal_friction_kg_m3_s = " + text.friction +
          "\n[strand]\nlength_m = 0.1\nelements = " + text.elements + "\n" + text.rest +
          text.drive,
      "driven.toml");
}

std::string number(double x) { return number_text(x); }

/// The equilibrium of a scene's strand, found from its start.
struct AtRest {
  explicit AtRest(const Scene& scene)
      : system(SceneSupports(scene).on(testing_support::system_of(scene),
                                       scene.strands.front(), 0)),
        at(*system) {
    EXPECT_TRUE(come_to_rest(dynamic_cast<models::SupportedSystem&>(*system), at.q));
    x.resize(3 * std::size_t(system->material_points()->count()));
    system->material_points()->positions(0, at.q, x);
  }
  Vec tip() const { return load3(&x[x.size() - 3]); }

  std::unique_ptr<System> system;
  Start at;
  std::vector<double> x;
};

/// Tip of a straight strand along x that a moment about y bends to the curvature k.
Vec tip_of_arc(double k) {
  return {std::sin(k * length) / k, 0, -(1 - std::cos(k * length)) / k};
}

/// Each row as [keys of a support, part of the message].
TEST(CompliantSupport, RefusesKeysThatDoNothing) {
  const auto why = [](const std::string& keys) {
    Text text;
    text.drive = "[[supports]]\n" + keys + "\n";
    return refusal([&] { scene_of(text); });
  };
  const std::pair<const char*, const char*> rows[] = {
      {"damping_n_s_per_m = 1", "damping_n_s_per_m of a rigid support"},
      {"kind = \"clamp\"\nstiffness_n_per_m = 1\nturn_damping_n_m_s_per_rad = 1",
       "turn_damping_n_m_s_per_rad of a rigid support"},
      {"turn_stiffness_n_m_per_rad = 1", "which holds no direction"},
      {"kind = \"direction\"\nstiffness_n_per_m = 1", "which holds no position"}};
  for (const auto& [keys, message] : rows) {
    EXPECT_NE(why(keys).find(message), std::string::npos) << why(keys);
    EXPECT_NE(why(keys).find("driven.toml:"), std::string::npos) << why(keys);
  }
  EXPECT_EQ(why("stiffness_n_per_m = 1\ndamping_n_s_per_m = 1"), "");
}

/// A moment M at the tip bends a cantilever to a circle of curvature M/EI, here by 2 rad,
/// dead or following. Elements of constant curvature are exact. Edges err by order 2,
/// less than half the square of the angle of a joint, 2/20 rad.
TEST(PointMoment, BendsACantileverToACircle) {
  const double k = 2 / length;
  for (const char* model :
       {"super_helix", "super_clothoid", "articulated_chain", "force_transport", "der",
        "corde", "xpbd_cosserat", "dynamic_spline"}) {
    for (const char* key : {"moment_n_m", "follower_n_m"}) {
      Text text;
      text.model = "id = \"" + std::string(model) + "\"";
      text.drive = "[[effects.point_moment]]\n" + std::string(key) + " = [0, " +
                   number(k * bending) + ", 0]\n";
      const AtRest rest(scene_of(text));
      const double off = norm(rest.tip() - tip_of_arc(k)) / length;
      const std::string name = model;
      std::printf("%s, %s: tip off by %.1e of the length\n", model, key, off);
      EXPECT_LE(off, name.starts_with("super") ? 1e-9 : 5e-3) << model << " " << key;
    }
  }
}

/// A planar strand and models without twist take a dead moment.
TEST(PointMoment, BendsModelsWithoutTwistIfItKeepsItsDirection) {
  const double k = 1 / length;
  for (const char* model : {"id = \"super_helix\"\nmodes = \"bend_planar\"",
                            "id = \"super_helix\"\nmodes = \"bend\"",
                            "id = \"mass_spring\"", "id = \"lifted_curls\""}) {
    Text text;
    text.model = model;
    text.drive =
        "[[effects.point_moment]]\nmoment_n_m = [0, " + number(k * bending) + ", 0]\n";
    const AtRest rest(scene_of(text));
    const double off = norm(rest.tip() - tip_of_arc(k)) / length;
    std::printf("%s: tip off by %.1e of the length\n", model, off);
    EXPECT_LE(off, 1e-3) << model;
  }
}

/// A moment about the tangent twists the strand by M L/(G J), here 3 rad. Strains of
/// corde are sines of half the angles of 0.15 rad between edges: 0.4 % off. Bar: 0.02
/// rad.
TEST(PointMoment, TwistsAStrandByItsLengthOverTheStiffness) {
  for (const char* model : {"super_helix", "super_clothoid", "der", "corde"}) {
    Text text;
    text.model = "id = \"" + std::string(model) + "\"";
    text.drive = "[[effects.point_moment]]\nfollower_n_m = [" +
                 number(3 * twisting / length) + ", 0, 0]\n";
    const AtRest rest(scene_of(text));
    const auto axes = rest.system->material_points()->end_frame(0, rest.at.q);
    ASSERT_TRUE(axes) << model;
    // e1 began as y: it has turned about x by the angle. Models with edges give the frame
    // of the middle of the last one.
    const bool edges = std::string(model) == "der" || std::string(model) == "corde";
    const double expected = edges ? 3 * (1 - 1.0 / 40) : 3;
    const double angle = std::atan2((*axes)[5], (*axes)[4]);
    EXPECT_NEAR(std::cos(angle - expected), 1, 2e-4) << model;
  }
}

/// Moments add up, follow their factor, and may act on interior points.
TEST(PointMoment, FollowsItsFactorAtItsPlace) {
  const double k = 1 / length;
  Text text;
  text.drive = "[[effects.point_moment]]\nat = 0.5\nmoment_n_m = [0, " +
               number(2 * k * bending) + ", 0]\nfactor_over_time = [[0, 0.5], [1, 2]]\n";
  const Scene scene = scene_of(text);
  const AtRest rest(scene);
  // Half of the strand is an arc of k, the other half straight.
  const double angle = k * length / 2, half = length / 2;
  const Vec expected{std::sin(angle) / k + half * std::cos(angle), 0,
                     -(1 - std::cos(angle)) / k - half * std::sin(angle)};
  EXPECT_LE(norm(rest.tip() - expected), 1e-9 * length);
  EXPECT_EQ(rest.system->next_breakpoint(0), 1);
  // A scene that is written is read as the same.
  const std::string written = scene_text(scene);
  EXPECT_NE(written.find("[[effects.point_moment]]"), std::string::npos);
  EXPECT_EQ(scene_text(parse_scene(written, "again.toml")), written);
}

/// Each row as [key lines, part of the message].
TEST(PointMoment, RefusesWhatCannotTurnTheStrand) {
  const auto why = [](const std::string& model, const std::string& keys) {
    Text text;
    text.model = model;
    text.drive = "[[effects.point_moment]]\n" + keys + "\n";
    return refusal([&] { scene_of(text); });
  };
  const std::string helix = "id = \"super_helix\"", one = "moment_n_m = [0, 1e-9, 0]";
  EXPECT_EQ(why(helix, ""), "");  // of 0
  Text misspelt;
  misspelt.drive = "[[effects.point_momen]]\nmoment_n_m = [0, 1e-9, 0]\n";
  EXPECT_NE(refusal([&] { scene_of(misspelt); }).find("did you mean 'point_moment'?"),
            std::string::npos);
  EXPECT_NE(why(helix, one + "\nat = 0.33").find("give at = 0.35"), std::string::npos);
  EXPECT_NE(why(helix, one + "\nat = 0").find("clamped root"), std::string::npos);
  EXPECT_NE(why(helix, one + "\nfactor_over_time = [[1, 1], [1, 2]]")
                .find("the times of factor_over_time do not increase"),
            std::string::npos);
  EXPECT_NE(why("id = \"der\"", one + "\nat = 0.5").find("jumps at this point"),
            std::string::npos);
  EXPECT_NE(why("id = \"mass_spring\"", "follower_n_m = [0, 1e-9, 0]")
                .find("a direction but no twist"),
            std::string::npos);
  EXPECT_NE(
      why("id = \"super_helix\"\nmodes = \"bend_planar\"", "moment_n_m = [0, 1e-9, 1e-9]")
          .find("the normal of its plane"),
      std::string::npos);
  for (const std::string& message :
       {why(helix, one + "\nat = 0"), why(helix, one + "\nat = 0.33")}) {
    EXPECT_NE(message.find("driven.toml:"), std::string::npos) << message;
  }
}

/// At a support that holds the section, edges take no moment, which would act on the last
/// edge: not even a soft support. A free axis and a held place refuse nothing.
TEST(PointMoment, RefusesHeldEndsOfModelsWhoseEdgesDoNotBend) {
  const auto why = [](const std::string& model, const std::string& support,
                      const std::string& moment) {
    Text text;
    text.model = "id = \"" + model + "\"";
    text.drive = "[[supports]]\nat = \"tip\"\n" + support +
                 "\n[[effects.point_moment]]\n" + moment + "\n";
    return refusal([&] { scene_of(text); });
  };
  const std::string clamp = "kind = \"clamp\"\nslide = [1, 0, 0]",
                    direction = "kind = \"direction\"",
                    hinge = "kind = \"hinge\"\naxis = [0, 1, 0]",
                    across = "moment_n_m = [0, 1e-9, 0]",
                    along = "moment_n_m = [1e-9, 0, 0]";
  for (const char* model : {"der", "corde", "xpbd_cosserat", "articulated_chain",
                            "force_transport", "mass_spring", "lifted_curls"}) {
    for (const std::string& support :
         {clamp, direction, direction + "\nturn_stiffness_n_m_per_rad = 1e-9"}) {
      const std::string said = why(model, support, across);
      EXPECT_NE(said.find("the section is held"), std::string::npos) << model << said;
      EXPECT_NE(said.find("driven.toml:"), std::string::npos) << said;
    }
    EXPECT_EQ(why(model, "kind = \"ball\"\nslide = [1, 0, 0]", across), "") << model;
  }
  for (const char* moment :
       {"moment_n_m = [0, 0, 1e-9]", "follower_n_m = [1e-9, 0, 0]"}) {
    EXPECT_NE(why("der", hinge, moment), "") << moment;
  }
  EXPECT_EQ(why("der", hinge, across), "");
  EXPECT_EQ(why("der", direction, along), "");
  EXPECT_NE(why("der", direction + "\ndirections = [[0, 1, 0, 0], [1, 1, 1, 0]]", along),
            "");
  EXPECT_NE(why("der", clamp, along), "");
  for (const char* model : {"super_helix", "super_clothoid"}) {
    EXPECT_EQ(why(model, clamp, across), "") << model;
  }
}

/// A muscle that bends a straight strand: curvature from 0 to k in 0.2 s. The slowest
/// mode, at 27 rad/s with a damping ratio of 0.6, leaves 1e-5 of its motion 0.8 s later:
/// the strand rests as the arc of its natural curvature. Edges err as above.
TEST(NaturalShape, EndsAsTheArcThatItDescribes) {
  const double k = 2 / length;
  for (const char* model : {"super_helix", "super_clothoid", "articulated_chain", "der",
                            "corde", "xpbd_cosserat", "dynamic_spline"}) {
    Text text;
    text.model = "id = \"" + std::string(model) + "\"";
    text.drive = "[[effects.natural_shape]]\ncurvature_per_m = [[0, 0], [0.2, " +
                 number(k) + "]]\n";
    World world(scene_of(text));
    ASSERT_EQ(world.advance(1), Status::ok) << world.failure();
    const std::vector<double>& x = world.positions();
    const double off = norm(load3(&x[x.size() - 3]) - tip_of_arc(k)) / length;
    std::printf("%s: tip off by %.1e of the length\n", model, off);
    EXPECT_LE(off, std::string(model).starts_with("super") ? 1e-4 : 5e-3) << model;
  }
}

/// A curl that dries: scale 0 to 1 of a natural curvature ends as the strand whose
/// natural curvature does not change, and begins straight.
TEST(NaturalShape, ScalesTheShapeOfTheTables) {
  Text text;
  text.rest = "shape = \"helix\"\ncurl_radius_m = 0.05\ncurl_pitch_m = 0\n";
  text.drive = "[[effects.natural_shape]]\nscale_over_time = [[0, 1], [0.2, 0.25]]\n";
  World world(scene_of(text));
  ASSERT_EQ(world.advance(1), Status::ok) << world.failure();
  const std::vector<double>& x = world.positions();
  EXPECT_LE(norm(load3(&x[x.size() - 3]) - tip_of_arc(5)), 1e-3 * length);
}

/// A part of the strand changes, to its elements' ends or between them.
TEST(NaturalShape, ChangesAPartOfTheStrand) {
  const double k = 10;
  Text text;
  text.elements = "8";
  text.drive = "[[effects.natural_shape]]\nfrom = 0.5\ncurvature_per_m = [[0, 10]]\n";
  const AtRest rest(scene_of(text));
  const double half = length / 2;
  const Vec expected{half + std::sin(k * half) / k, 0, -(1 - std::cos(k * half)) / k};
  EXPECT_LE(norm(rest.tip() - expected), 1e-9 * length);
}

/// Springs, moments and natural shapes together add no constraints: the formulation stays
/// that of the model.
TEST(NaturalShape, RunsWithMomentsAndCompliantSupports) {
  Text text;
  text.duration = "0.02";
  text.drive =
      "[[effects.natural_shape]]\ncurvature_per_m = [[0, 0], [0.02, 20]]\n"
      "[[effects.point_moment]]\nmoment_n_m = [0, 0, 1e-9]\n"
      "[[supports]]\nstiffness_n_per_m = 0.01\n[[supports]]\nat = 0.5\n"
      "stiffness_n_per_m = 0.01\n";
  const Scene scene = scene_of(text);
  EXPECT_EQ(scene.options.formulation, Formulation::parametric);
  World world(scene);
  ASSERT_EQ(world.advance(0.02), Status::ok) << world.failure();
  EXPECT_EQ(world.support_loads().forces.size(), 6U);
}

TEST(NaturalShape, RefusesWhatTheModelOrTheTableDoesNotAdmit) {
  const auto why = [](const std::string& model, const std::string& keys) {
    Text text;
    text.model = model;
    text.drive = "[[effects.natural_shape]]\n" + keys + "\n";
    return refusal([&] { scene_of(text); });
  };
  const std::string helix = "id = \"super_helix\"", one = "scale_over_time = [[0, 1]]";
  EXPECT_NE(why(helix, one + "\nfrom = 0.5\nto = 0.5").find("give from < to"),
            std::string::npos);
  EXPECT_NE(why(helix, "twist_per_m = [[1, 1], [0, 2]]")
                .find("the times of twist_per_m do not increase"),
            std::string::npos);
  EXPECT_NE(why("id = \"mass_spring\"", one).find("lacks a natural strain"),
            std::string::npos);
  EXPECT_EQ(why(helix, one), "");
  const std::string clothoid =
      why("id = \"super_clothoid\"", "twist_per_m = [[0, 0], [1, 1e4]]");
  EXPECT_NE(clothoid.find("the natural shape at t = 1 s: an element of linear curvature "
                          "winds by more than 24 rad"),
            std::string::npos)
      << clothoid;
  EXPECT_NE(clothoid.find("driven.toml:"), std::string::npos) << clothoid;
}

}  // namespace tress::test_driven_scenes
