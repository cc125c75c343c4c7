// Curves of USD: where they are, whether they are drawn, and which basis they suit, as
// OpenUSD has it; cases after public reports.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "simulation/files/files.h"
#include "simulation/groom/place_groom.h"
#include "tests/support/refusal.h"

namespace tress::test_usd_curves {

using namespace simulation;
using testing::AllOf;
using testing::HasSubstr;
using testing_support::refusal;

GroomFile read(const std::string& stage, const GroomReading& reading = {}) {
  const std::string name =
      testing::TempDir() + "usd_curves_" + std::to_string(getpid()) + ".usda";
  replace_file(name, "#usda 1.0\n" + stage);
  struct Remove {
    const std::string& name;
    ~Remove() { std::filesystem::remove(name); }
  } remove{name};
  return read_groom(name, reading);
}

/// A straight strand from (1, 2, 3) to (1, 2, 1).
std::string strand(const std::string& attributes = "", const std::string& head = "def") {
  return head +
         " BasisCurves \"h\"\n{\nuniform token type = \"linear\"\n"
         "int[] curveVertexCounts = [2]\npoint3f[] points = [(1, 2, 3), (1, 2, 1)]\n" +
         attributes + "}\n";
}
std::string within(const std::string& attributes, const std::string& what = strand(),
                   const std::string& head = "def Xform") {
  return head + " \"x\"\n{\n" + attributes + what + "}\n";
}
std::string ordered(const std::string& attributes, const std::string& order) {
  return attributes + "uniform token[] xformOpOrder = [" + order + "]\n";
}

Vec first_point(const std::string& stage) { return read(stage).lines.points.at(0); }

void expect_place(const Vec& x, const Vec& expected) {
  EXPECT_NEAR(norm(x - expected), 0, 1e-14) << x.x << ' ' << x.y << ' ' << x.z;
}

/// Operations apply from last to first; those that the order does not name do not.
TEST(UsdTransforms, AreComposedInTheirOrder) {
  const std::string moved = "double3 xformOp:translate = (10, 0, 0)\n";
  const std::string turned = "float xformOp:rotateZ = 90\n";
  const std::string t = "\"xformOp:translate\"", r = "\"xformOp:rotateZ\"";
  expect_place(first_point(within(ordered(moved + turned, t + ", " + r))), {8, 1, 3});
  expect_place(first_point(within(ordered(moved + turned, r + ", " + t))), {-2, 11, 3});
  expect_place(first_point(within(ordered(moved, ""))), {1, 2, 3});
  expect_place(first_point(within(moved)), {1, 2, 3});
  // After the prims within, and on the curves themselves.
  expect_place(first_point("def Xform \"x\"\n{\n" + strand() + ordered(moved, t) + "}\n"),
               {11, 2, 3});
  expect_place(first_point(strand(ordered(moved, t))), {11, 2, 3});
  // Of an animation the first frame.
  expect_place(
      first_point(within(ordered(
          "double3 xformOp:translate.timeSamples = {0: (0, 0, 5), 1: (9, 9, 9)}\n", t))),
      {1, 2, 8});
}

/// A pivot that is the origin's place of a rotation by nothing is nothing; of one by 90
/// degrees about z through (1, 0, 0), the point (1, 2, 3) becomes (-1, 0, 3).
TEST(UsdTransforms, InvertPivots) {
  const auto pivot = [](const std::string& place, int angle) {
    return ordered(fmt::format("double3 xformOp:translate:p = {}\n"
                               "float3 xformOp:rotateXYZ = (0, 0, {})\n",
                               place, angle),
                   "\"xformOp:translate:p\", \"xformOp:rotateXYZ\", "
                   "\"!invert!xformOp:translate:p\"");
  };
  EXPECT_EQ(norm(first_point(within(pivot("(0, 0, 1.6)", 0))) - Vec{1, 2, 3}), 0);
  expect_place(first_point(within(pivot("(1, 0, 0)", 90))), {-1, 0, 3});
}

struct Operation {
  const char* name;
  const char* value;
  Vec place;  // of (1, 2, 3)
};
class UsdOperation : public testing::TestWithParam<Operation> {};

/// Rotations about several axes apply in the order of their letters; matrices have the
/// translation in their last row.
TEST_P(UsdOperation, MapsAPoint) {
  const auto& [name, value, place] = GetParam();
  const std::string attribute = fmt::format("custom_type xformOp:{} = {}\n", name, value);
  expect_place(
      first_point(within(ordered(attribute, fmt::format("\"xformOp:{}\"", name)))),
      place);
  const std::string back = fmt::format("\"xformOp:{0}\", \"!invert!xformOp:{0}\"", name);
  expect_place(first_point(within(ordered(attribute, back))), {1, 2, 3});
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, UsdOperation,
    testing::Values(Operation{"translate", "(1, 1, 1)", {2, 3, 4}},
                    Operation{"translateY", "5", {1, 7, 3}},
                    Operation{"scale", "(2, 3, 4)", {2, 6, 12}},
                    Operation{"scaleZ:s", "0.5", {1, 2, 1.5}},
                    Operation{"rotateX", "90", {1, -3, 2}},
                    Operation{"rotateY", "90", {3, 2, -1}},
                    Operation{"rotateXYZ", "(90, 90, 0)", {2, -3, -1}},
                    Operation{"rotateYXZ", "(90, 90, 0)", {3, 1, 2}},
                    Operation{"orient",
                              "(0.70710678118654752, 0, 0, 0.70710678118654752)",
                              {-2, 1, 3}},
                    Operation{"transform",
                              "((0, 1, 0, 0), (-1, 0, 0, 0), (0, 0, 2, 0), (7, 8, 9, 1))",
                              {5, 9, 15}}));

TEST(UsdTransforms, NestAndResetTheStack) {
  const auto move = [](double x, const std::string& before = "") {
    return ordered(fmt::format("double3 xformOp:translate = ({}, 0, 0)\n", x),
                   before + "\"xformOp:translate\"");
  };
  expect_place(first_point(within(move(10), within(move(100)))), {111, 2, 3});
  expect_place(
      first_point(within(move(10), within(move(100, "\"!resetXformStack!\", ")))),
      {101, 2, 3});
  // Scopes and prims without type have none.
  expect_place(first_point(within(move(10), strand(), "def Scope")), {1, 2, 3});
  for (const char* broken :
       {"matrix4d xformOp:a = ((1, 0, 0, 1), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1))\n",
        "float3 xformOp:a = (1, 2)\n", ""}) {
    EXPECT_THAT(refusal([&] { read(within(ordered(broken, "\"xformOp:a\""))); }),
                AllOf(HasSubstr("xformOp:a"), HasSubstr("apply the transform")));
  }
  EXPECT_THAT(refusal([&] {
                read(within(ordered("float3 xformOp:scale = (1, 0, 1)\n",
                                    "\"!invert!xformOp:scale\"")));
              }),
              HasSubstr("!invert!xformOp:scale"));
}

struct HiddenCase {
  const char* name;
  std::string stage;
  const char* why;
};
class UsdHidden : public testing::TestWithParam<HiddenCase> {};

/// One strand is drawn, one is not; an option takes both.
TEST_P(UsdHidden, IsLeftOutAndCounted) {
  const auto& [name, hidden, why] = GetParam();
  const GroomFile left = read(hidden + strand());
  EXPECT_EQ(left.lines.size(), 1u);
  EXPECT_EQ(left.lines.numbers[0], 1u);
  EXPECT_THAT(left.notes.at(0), HasSubstr(fmt::format("are left out: 1 {} (", why)));
  GroomReading all;
  all.hidden = true;
  const GroomFile taken = read(hidden + strand(), all);
  EXPECT_EQ(taken.lines.size(), 2u);
  EXPECT_THAT(taken.notes.at(0), HasSubstr(fmt::format("are taken: 1 {}", why)));
  EXPECT_THAT(refusal([&] { read(hidden); }),
              AllOf(HasSubstr("no curve that USD renders"),
                    HasSubstr("hidden_strands = \"take\"")));
}

INSTANTIATE_TEST_SUITE_P(
    Reasons, UsdHidden,
    testing::Values(HiddenCase{"Inactive",
                               "def Xform \"x\" (\nactive = false\n)\n{\n" + strand() +
                                   "}\n",
                               "inactive"},
                    HiddenCase{"Abstract", strand("", "class"), "of a class"},
                    HiddenCase{"Undefined", strand("", "over"), "without def (over)"},
                    HiddenCase{"Invisible",
                               within("token visibility = \"invisible\"\n",
                                      strand("token visibility = \"inherited\"\n")),
                               "invisible"},
                    HiddenCase{"Guide", within("uniform token purpose = \"guide\"\n"),
                               "of purpose guide"},
                    HiddenCase{"Proxy", strand("uniform token purpose = \"proxy\"\n"),
                               "of purpose proxy"}),
    [](const auto& one) { return one.param.name; });

/// The nearest purpose counts; of a render purpose curves are drawn.
TEST(UsdPurpose, IsThatOfTheNearestPrim) {
  const std::string guide = "uniform token purpose = \"guide\"\n";
  for (const char* shown : {"render", "default"}) {
    const std::string own = fmt::format("uniform token purpose = \"{}\"\n", shown);
    EXPECT_EQ(read(within(guide, strand(own))).lines.size(), 1u);
    EXPECT_THAT(refusal([&] { read(within(own, strand(guide))); }), HasSubstr("guide"));
  }
}

std::string cubic(const std::string& basis, int count, const std::string& wrap = "") {
  std::string points;
  for (int i = 0; i < count; ++i) {
    points += fmt::format("{}(0, 0, {})", i > 0 ? ", " : "", 1.8 - 0.02 * i);
  }
  return fmt::format(
      "def BasisCurves \"h\"\n{{\nuniform token type = \"cubic\"\nuniform token basis = "
      "\"{}\"\n{}int[] curveVertexCounts = [{}]\npoint3f[] points = [{}]\n}}\n",
      basis, wrap.empty() ? "" : "uniform token wrap = \"" + wrap + "\"\n", count,
      points);
}

/// The number that does not suit is said, with those that do.
TEST(UsdBasis, SaysWhichNumberOfPointsItNeeds) {
  EXPECT_THAT(refusal([] { read(cubic("bezier", 6)); }),
              AllOf(HasSubstr("strand 0 has 6 points, but bezier curves need 4, 7, 10"),
                    HasSubstr("line ")));
  EXPECT_THAT(
      refusal([] { read(cubic("catmullRom", 3)); }),
      HasSubstr("strand 0 has 3 points, but catmullRom curves that are not pinned "
                "need 4 points or more"));
  EXPECT_THAT(refusal([] { read(cubic("bspline", 1, "pinned")); }),
              HasSubstr("has 1 point, but pinned bspline curves need 2"));
  GroomReading drop;
  drop.bad = BadStrands::drop;
  const GroomFile left = read(cubic("bezier", 6) + cubic("bezier", 7), drop);
  EXPECT_EQ(left.lines.size(), 1u);
  EXPECT_EQ(left.lines.numbers[0], 1u);
  EXPECT_THAT(left.notes.at(0), HasSubstr("1 strand left out: the number of points"));
  for (const char* wrap : {"periodic", "knotted"}) {
    EXPECT_THAT(refusal([&] { read(cubic("catmullRom", 6, wrap)); }), HasSubstr(wrap));
  }
}

/// Six points 0.02 apart: without pins the first and the last of five pieces are not on
/// the curve, with pins all are. Unsaid, there are none.
TEST(UsdBasis, KeepsTheEndsOfPinnedCurvesAndSaysWhatOthersLose) {
  for (const char* basis : {"catmullRom", "bspline"}) {
    for (const char* wrap : {"", "nonperiodic"}) {
      const GroomFile open = read(cubic(basis, 6, wrap));
      EXPECT_NEAR(open.lines.points.front().z, 1.78, 1e-15);
      EXPECT_NEAR(open.lines.points.back().z, 1.72, 1e-15);
      EXPECT_THAT(open.notes.at(0), AllOf(HasSubstr("not pinned"), HasSubstr("40 %")));
    }
    const GroomFile pinned = read(cubic(basis, 6, "pinned"));
    EXPECT_NEAR(pinned.lines.points.front().z, 1.8, 1e-15);
    EXPECT_NEAR(pinned.lines.points.back().z, 1.7, 1e-15);
    EXPECT_TRUE(pinned.notes.empty());
    EXPECT_NEAR(read(cubic(basis, 2, "pinned")).lines.points.back().z, 1.78, 1e-15);
  }
}

/// Without metersPerUnit and upAxis: centimetres and y, with a note unless the scene says
/// so.
TEST(UsdUnits, FallBackAsTheFormatHasIt) {
  const GroomFile fur = read(strand());
  const PlacedGroom placed = place_groom(fur, "f", {});
  expect_place(placed.lines.points[0], {0.03, 0.01, 0.02});
  EXPECT_THAT(placed.notes.at(0), HasSubstr("no unit: 0.01 m"));
  EXPECT_THAT(placed.notes.at(1), HasSubstr("no axis that points up: y"));
  GroomPlacing given;
  given.metres = 1;
  given.up = FileAxis{2, false};
  EXPECT_EQ(place_groom(fur, "f", given).notes.size(), 1u);
}

TEST(UsdText, ReadsNamesAndMetadataOfAnyKind) {
  const GroomFile odd = read(
      "(\n\"\"\"a (comment\"\"\"\nsubLayers = [@it's.usda@ (offset = 1), @@@b@c@@@]\n"
      "customLayerData = { string \xC3\xBC = \"}\" }\n)\ndef Xform \"Stra\xC3\xA3o\" (\n"
      "prepend references = @a.usda@</b>\nkind = \"group\"\n)\n{\n"
      "custom float \xC3\xBCser:\xE6\xAF\x9B = 1 (doc = \"x)\")\nasset a = @@\n"
      "rel material:binding = </a/b>\nvariantSet \"v\" = { \"one\" { } }\n" +
      strand("float[] widths = [1] (interpolation = \"constant\")\n") + "}\n");
  EXPECT_EQ(odd.lines.size(), 1u);
}

}  // namespace tress::test_usd_curves
