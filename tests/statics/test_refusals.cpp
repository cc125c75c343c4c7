// statics refuses what has no answer, in one line with the reason and a remedy.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/harness/toy_process.h"
#include "tests/statics/static_scenes.h"

namespace tress::test_refusals {

using namespace testing_support;
using testing::HasSubstr;

const std::string strand = "length_m = 0.1\nelements = 10";
const std::string gravity = "[effects.gravity]\n";

struct Refused {
  std::string name, model, more, options, reason, remedy;
};

void PrintTo(const Refused& refused, std::ostream* out) { *out << refused.name; }

class RefusedTest : public testing::TestWithParam<Refused> {};

TEST_P(RefusedTest, InOneLineWithExitCodeTwo) {
  const Refused& refused = GetParam();
  Toy toy;
  toy.write("s.toml", static_scene(refused.model, strand, refused.more));
  const auto before = toy.files();
  const Toy::Result result =
      toy.run("--scene s.toml --out t.csv --progress none " + refused.options);
  EXPECT_EQ(result.code, 2) << result.err;
  EXPECT_EQ(result.error_lines(), 1) << result.err;
  EXPECT_THAT(result.err, HasSubstr(refused.reason));
  EXPECT_THAT(result.err, HasSubstr(refused.remedy));
  EXPECT_EQ(toy.files(), before);
  EXPECT_EQ(result.out, "");
}

const std::string helix = "id = \"super_helix\"";
const std::string force = "[[effects.point_force]]\nforce_n = [0, 0, 1e-6]\n";

const Refused refusals[] = {
    {"UnknownName", helix, gravity, "--over gravty=0..1", "nothing named 'gravty'",
     "did you mean 'gravity'?"},
    {"UnknownNumber", helix, gravity, "--over youngs_modulus=1e9..2e9",
     "unknown parameter 'youngs_modulus'", "did you mean 'youngs_modulus_pa'?"},
    {"EmptyRange", helix, gravity, "--over gravity=1..1", "are the same",
     "give different numbers"},
    {"SupportsBack", helix,
     "[[supports]]\nslide = [1, 0, 0]\nkeyframes = [[0, 0.1, 0, 0], [1, 0.1, 0, 0.01]]\n",
     "--over supports=0..-1", "goes back", "give --over supports=0..1"},
    {"NoRange", helix, gravity, "--over gravity=1", "is not a range", "give FROM..TO"},
    {"NotANumber", helix, gravity, "--over gravity=a..1", "'a' is not a number",
     "give a range"},
    {"NumberWithoutRange", helix, gravity, "--over radius_m", "no range of radius_m",
     "give --over radius_m=FROM..TO"},
    {"NumberOutOfRange", helix, gravity, "--over radius_m=-1..1", "is out of range",
     "give numbers between 1e-"},
    {"NoSuchEffect", helix, gravity, "--over point_force=0..1",
     "the scene has no [effects.point_force]", "give one of gravity"},
    {"NoSecondForce", helix, force, "--over point_force_2=0..1",
     "the scene has no [effects.point_force_2]", "did you mean 'point_force'?"},
    {"WhichForce", helix, force + force, "", "several point forces",
     "give --over point_force"},
    {"NothingVaries", helix, "", "", "no load that can vary",
     "add [[effects.point_force]]"},
    {"SupportsAtRest", helix, "[[supports]]\nkeyframes = [[0, 0.09, 0, 0]]\n",
     "--over supports", "no support that moves", "two rows"},
    {"NoStrand", helix, gravity, "--strand 2", "no strand 2", "give a number of 1 to 1"},
    {"NothingHolds", helix, "[root]\nmotion = \"free\"\n" + gravity, "",
     "nothing holds has no equilibrium", "give [[supports]]"},
    {"Friction", helix,
     gravity + "[[effects.body]]\nshape = \"sphere\"\nfriction = 0.3\n", "",
     "depends on how the strand came there", "give friction = 0"},
    {"Nodal", "id = \"kirchhoff_nodal\"",
     "[[supports]]\nkeyframes = [[0, 0.09, 0, 0]]\n" + gravity, "",
     "does not compute the accelerations", "use another model"},
    {"OtherIntegrator", helix, gravity, "--integrators bdf2", "nothing moves in it",
     "leave it out"},
    {"OtherGeometry", helix, gravity, "--models tinkertoys",
     "has a geometry of its own and no strand", "such as super_helix"},
};

INSTANTIATE_TEST_SUITE_P(Statics, RefusedTest, testing::ValuesIn(refusals),
                         [](const auto& run) { return run.param.name; });

/// A model with a geometry of its own.
TEST(Statics, RefusesAModelWithoutStrand) {
  Toy toy;
  toy.write("s.toml",
            "title = \"t\"\nduration_s = 1\n[model]\nid = "
            "\"tinkertoys\"\n[integrator]\nid = \"bdf2\"\nformulation = \"index3\"\n");
  const Toy::Result result = toy.run("--scene s.toml --out t.csv --progress none");
  EXPECT_EQ(result.code, 2) << result.err;
  EXPECT_THAT(result.err, HasSubstr("has a geometry of its own and no strand"));
}

/// A support that pulls an inextensible strand taut: the path ends there, in a row with
/// the reason, and the exit code is 3.
TEST(Statics, EndsAPathThatFailsWithARowAndItsReason) {
  Toy toy;
  toy.write(
      "s.toml",
      static_scene("id = \"super_helix\"\nmodes = \"bend_planar\"",
                   "length_m = 0.1\nelements = 4\nroot_tangent = [1, 0, 0.5]\nshape "
                   "= \"along\"\ndarboux_along = [[0, 0, 10, 0]]",
                   "[[supports]]\nat = \"tip\"\nslide = [1, 0, 0]\nkeyframes = [[0, "
                   "0, 0, 0.0], [1, 0, 0, -0.2]]\n"));
  const Toy::Result result = toy.run("--scene s.toml --out t.csv --progress none");
  EXPECT_EQ(result.code, 3) << result.err;
  EXPECT_THAT(result.out, HasSubstr("the step vanishes: "));
  EXPECT_THAT(toy.read("t.csv"), HasSubstr(",diverged,"));
}

/// Table, pictures, shapes and words of a path.
TEST(Statics, WritesAPathAndItsPictures) {
  Toy toy;
  toy.write("s.toml", column("id = \"super_helix\"\nmodes = \"bend_planar\"", 10));
  const Toy::Result result = toy.run(
      "--scene s.toml --over point_force=0..3 --out t.csv --progress none --elements "
      "10,20");
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("bifurcation: point_force = 2.47"));
  EXPECT_THAT(result.out, HasSubstr("stable before, unstable after"));
  EXPECT_THAT(result.out, HasSubstr("verified: "));
  EXPECT_THAT(result.out, HasSubstr("bifurcations differ by 0.15 %"));
  for (const char* file : {"t.csv", "t.meta.json", "t/s.super_helix.10.svg",
                           "t/s.super_helix.20.svg", "t/s.super_helix.10.shapes.csv"}) {
    EXPECT_TRUE(toy.exists(file)) << file;
  }
  const std::string svg = toy.read("t/s.super_helix.10.svg");
  EXPECT_THAT(svg, HasSubstr("force (N)"));
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

}  // namespace tress::test_refusals
