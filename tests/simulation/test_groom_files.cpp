// Strands from files of other programs: what was written is read, units, axes and curves
// are what they say, and no bytes whatever do harm.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <ctime>
#include <filesystem>

#include "contract/input_error.h"
#include "simulation/export/export.h"
#include "simulation/files/files.h"
#include "simulation/groom/curve_basis.h"
#include "simulation/groom/place_groom.h"
#include "tests/simulation/mutations.h"
#include "tests/support/groom_bytes.h"
#include "tests/support/made_groom.h"
#include "tests/support/refusal.h"

namespace tress::test_groom_files {

using namespace simulation;
using namespace testing_support;
using testing::AllOf;
using testing::HasSubstr;

constexpr const char* formats[] = {"hair",       "data",        "bin",  "ply",
                                   "ply.little", "ply.big",     "usda", "vtp",
                                   "vtp.binary", "vtp.appended"};

std::string file_of(const std::string& format) {
  return testing::TempDir() + "groom_files_" + std::to_string(getpid()) + "." +
         format.substr(0, format.find('.'));
}

/// A file with these bytes, as long as this lives.
struct WrittenFile {
  WrittenFile(const std::string& format, const std::string& bytes)
      : name(file_of(format)) {
    replace_file(name, bytes);
  }
  ~WrittenFile() { std::filesystem::remove(name); }
  std::string name;
};

GroomFile read_bytes(const std::string& format, const std::string& bytes) {
  const WrittenFile written(format, bytes);
  return read_groom(written.name);
}

MadeGroom few() {
  MadeGroom groom = ponytail();
  groom.locks = 2;
  groom.hairs = 3;
  groom.points = 12;
  return groom;
}

class GroomFormat : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Formats, GroomFormat, testing::ValuesIn(formats));

TEST_P(GroomFormat, IsReadAsItWasWritten) {
  const Polylines lines = made(few(), 3);
  const GroomFile read = read_bytes(GetParam(), groom_bytes(GetParam(), lines));
  EXPECT_EQ(read.lines.ends, lines.ends);
  EXPECT_EQ(read.lines.numbers, lines.numbers);
  ASSERT_EQ(read.lines.points.size(), lines.points.size());
  for (std::size_t i = 0; i < lines.points.size(); ++i) {
    // Written as floats: half an ulp of each component, all below 1 m.
    EXPECT_LE(norm(read.lines.points[i] - lines.points[i]), 1e-7);
  }
  EXPECT_EQ(read.metres.has_value(), std::string_view(GetParam()) == "usda");
}

/// A file that ends early, wherever it does, is refused in one line that names it; so is
/// one of which nothing is left.
TEST_P(GroomFormat, CutShortIsRefused) {
  const std::string whole = groom_bytes(GetParam(), made(few(), 3));
  for (int part = 0; part < 12; ++part) {
    const std::string cut =
        whole.substr(0, whole.size() * static_cast<std::size_t>(part) / 13);
    const std::string said = refusal([&] { read_bytes(GetParam(), cut); });
    // Text of which only the end of the last tag or brace is gone has all strands.
    EXPECT_THAT(said, HasSubstr("groom_files_")) << part;
    EXPECT_EQ(std::ranges::count(said, '\n'), 0);
  }
}

/// Bits, bytes and whole parts changed: each mutant is read or refused in a line that
/// names the file, within 1 s of processor time and 200 MB of memory.
TEST_P(GroomFormat, MutantsDoNoHarm) {
  const std::string whole = groom_bytes(GetParam(), made(few(), 3));
  Mutations mutations(7);
  const auto used_mib = [] {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss / 1024;
  };
  const long before = used_mib();
  int refused = 0;
  constexpr int mutants = 60;
  for (int i = 0; i < mutants; ++i) {
    std::string bytes = whole;
    if (i % 3 == 0) bytes = mutations.spoilt(std::move(bytes));
    for (std::size_t k = 0, n = mutations.pick(3) + (i % 3 == 0 ? 0 : 1); k < n; ++k) {
      // Half of all changes in the head of the file, where its sizes are.
      const std::size_t range = mutations.pick(2) == 0
                                    ? bytes.size()
                                    : std::min<std::size_t>(bytes.size(), 200);
      constexpr unsigned char some[] = {0, 1, 0x7f, 0x80, 0xff, '-', '9', '"', '(', ' '};
      bytes[mutations.pick(range)] =
          static_cast<char>(some[mutations.pick(std::size(some))]);
    }
    if (i % 5 == 0) bytes.erase(mutations.pick(bytes.size()), mutations.pick(40));
    const std::clock_t start = std::clock();
    const WrittenFile written(GetParam(), bytes);
    try {
      GroomPlacing placing;
      if (i % 2 == 0) placing.bad = BadStrands::drop;
      place_groom(read_groom(written.name), written.name, placing);
    } catch (const InputError& error) {
      ++refused;
      EXPECT_THAT(error.what(), HasSubstr(written.name));
      EXPECT_EQ(std::string_view(error.what()).find('\n'), std::string_view::npos);
    }
    EXPECT_LE(static_cast<double>(std::clock() - start), 1.0 * CLOCKS_PER_SEC) << i;
  }
  EXPECT_GE(refused, mutants / 6);
  EXPECT_LE(used_mib() - before, 200);
}

struct Lie {
  const char* name;
  const char* format;
  std::size_t at;
  std::string bytes;
  const char* said;
};

std::string four(std::uint32_t x) {
  return {reinterpret_cast<const char*>(&x), sizeof x};
}

class LyingSize : public testing::TestWithParam<Lie> {};

TEST_P(LyingSize, IsRefusedBeforeAnythingIsAllocated) {
  std::string bytes = groom_bytes(GetParam().format, made(few(), 3));
  bytes.replace(GetParam().at, GetParam().bytes.size(), GetParam().bytes);
  const std::string said = refusal([&] { read_bytes(GetParam().format, bytes); });
  EXPECT_THAT(said, HasSubstr(GetParam().said));
  EXPECT_THAT(said, HasSubstr("byte "));
}

INSTANTIATE_TEST_SUITE_P(
    Sizes, LyingSize,
    testing::Values(
        Lie{"Signature", "hair", 0, "HAIL", "begins neither with HAIR"},
        Lie{"HairStrands", "hair", 4, four(0x7fffffff), "where 2147483647 strands of"},
        Lie{"HairPoints", "hair", 8, four(0xffffffff), "of 4294967295 points with"},
        Lie{"HairBits", "hair", 12, four(1), "without points"},
        Lie{"DataStrands", "data", 0, four(0x7fffffff), "strands where"},
        Lie{"DataNegative", "data", 4, four(0xffffffff), "strand 0 has -1 points"},
        Lie{"DataPoints", "data", 4, four(0x7fffffff), "points of strand 0 where"},
        Lie{"BinFewer", "bin", 0, four(5), "are left after the last strand"}),
    [](const auto& lie) { return lie.param.name; });

TEST(GroomFiles, AreNamedByWhatTheyAre) {
  EXPECT_THAT(refusal([] { read_groom("nowhere.hair"); }), HasSubstr("no such file"));
  EXPECT_THAT(refusal([] { read_bytes("abc", "x"); }), HasSubstr("'.abc'"));
  EXPECT_THAT(refusal([] { read_bytes("usdc", "x"); }), HasSubstr("usdcat"));
  EXPECT_THAT(refusal([] { read_bytes("usda", "#usda 1.0\ndef Mesh \"m\"\n{\n}\n"); }),
              HasSubstr("no BasisCurves"));
  EXPECT_THAT(refusal([] {
                read_bytes("ply",
                           "ply\nformat ascii 1.0\nelement vertex 1\n"
                           "property float x\nproperty float y\n"
                           "property float z\nend_header\n1 2 3\n");
              }),
              HasSubstr("strand_points"));
}

/// A ply whose strands are not said, and one of edges.
TEST(GroomFiles, OfPlyMaySayTheirStrandsInSeveralWays) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty uchar r\n"
      "property double y\nproperty double z\n";
  const std::string places = "0 9 0 0\n1 9 0 0\n0 9 1 0\n1 9 1 0\n";
  const WrittenFile two("ply", head + "end_header\n" + places);
  EXPECT_EQ(read_groom(two.name, {.strand_points = 2}).lines.ends,
            (std::vector<std::size_t>{2, 4}));
  EXPECT_THAT(refusal([&] { read_groom(two.name, {.strand_points = 3}); }),
              HasSubstr("strands of 3"));
  const GroomFile edges =
      read_bytes("ply", head +
                            "element edge 2\nproperty int vertex1\nproperty int vertex2\n"
                            "end_header\n" +
                            places + "0 1\n2 3\n");
  EXPECT_EQ(edges.lines.ends, (std::vector<std::size_t>{2, 4}));
  EXPECT_EQ(edges.lines.points[3].y, 1);
}

std::string curves(const std::string& more, const std::string& top = "") {
  return "#usda 1.0\n(\n" + top + ")\ndef BasisCurves \"c\"\n{\n" + more + "}\n";
}

/// Of an animation the first frame counts.
TEST(GroomFiles, OfUsdAreReadAsTheyAreMeant) {
  const std::string two =
      "int[] curveVertexCounts = [2]\nuniform token type = \"linear\"\n";
  const GroomFile moving = read_bytes(
      "usda",
      curves(two + "point3f[] points.timeSamples = {\n0: [(0, 0, 0), (1, 2, 3)],\n"
                   "1: [(9, 9, 9), (8, 8, 8)],\n}\n",
             "metersPerUnit = 0.01\nupAxis = \"Y\"\n"));
  EXPECT_EQ(moving.lines.points[1].z, 3);
  EXPECT_THAT(moving.notes.at(0), HasSubstr("first frame"));
  EXPECT_EQ(moving.metres, 0.01);
  ASSERT_TRUE(moving.up);
  EXPECT_EQ(moving.up->axis, 1);
  const std::string still = two + "point3f[] points = [(0, 0, 0), (1, 2, 3)]\n";
  EXPECT_FALSE(read_bytes("usda", curves(still)).metres);
  EXPECT_THAT(refusal([&] {
                read_bytes("usda", curves(still + "uniform token wrap = \"periodic\"\n"));
              }),
              HasSubstr("that are open"));
}

/// Control points of a cubic are not on it: a parabola by its Bezier points, a straight
/// line by any, and where each basis begins and ends.
TEST(CurveBasis, EvaluatesTheCurve) {
  const std::vector<Vec> parabola{{0, 0, 0}, {1, 0, 0}, {2, 1, 0}, {3, 3, 0}};
  // y = x^2/3 has these control points.
  const std::vector<Vec> bezier = points_on(parabola, CurveBasis::bezier, false);
  ASSERT_EQ(bezier.size(), 5u);
  for (const Vec& x : bezier) EXPECT_NEAR(x.y, x.x * x.x / 3, 1e-15);
  const std::vector<Vec> line{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}};
  for (const CurveBasis basis : {CurveBasis::bspline, CurveBasis::catmull_rom}) {
    const std::vector<Vec> open = points_on(line, basis, false);
    const std::vector<Vec> pinned = points_on(line, basis, true);
    for (std::size_t i = 0; i < open.size(); ++i) {
      EXPECT_NEAR(open[i].x, 1 + static_cast<double>(i) / 4, 1e-15);
    }
    EXPECT_NEAR(open.back().x, 3, 1e-15);
    EXPECT_NEAR(pinned.front().x, 0, 1e-15);
    EXPECT_NEAR(pinned.back().x, 4, 1e-15);
  }
  EXPECT_EQ(points_on(parabola, CurveBasis::catmull_rom, false).front().x, 1);
  // (p0 + 4 p1 + p2)/6, the value of a B-spline at its knot.
  EXPECT_NEAR(points_on(parabola, CurveBasis::bspline, false).front().y, 1.0 / 6, 1e-15);
  EXPECT_TRUE(points_on(std::span(line).first(3), CurveBasis::bspline, false).empty());
  EXPECT_TRUE(points_on(line, CurveBasis::bezier, false).empty());
}

GroomPlacing placing(double metres, FileAxis up) {
  GroomPlacing made;
  made.metres = metres;
  made.up = up;
  return made;
}
GroomPlacing dropping() {
  GroomPlacing made;
  made.bad = BadStrands::drop;
  return made;
}
GroomPlacing every_second() {
  GroomPlacing made;
  made.every = 2;
  return made;
}

/// A strand of 0.2 m that hangs from (0.1, 0.2, 0.3) m, as a file with another unit and
/// axis has it.
TEST(PlacedGroom, HasMetresAndZUp) {
  GroomFile cm_y_up;
  cm_y_up.lines.points = {{20, 30, 10}, {25, 28, 10}, {25, 20, 10}, {20, 10, 10}};
  cm_y_up.lines.end_strand(0, 0);
  const auto check = [](const PlacedGroom& placed, std::size_t notes) {
    EXPECT_NEAR(norm(placed.lines.points[0] - Vec{0.1, 0.2, 0.3}), 0, 1e-15);
    EXPECT_NEAR(norm(placed.lines.points[3] - Vec{0.1, 0.2, 0.1}), 0, 1e-15);
    EXPECT_EQ(placed.notes.size(), notes + 1);
    EXPECT_THAT(placed.notes.back(), HasSubstr("lengths: 0.246 m each"));
  };
  check(place_groom(cm_y_up, "f", placing(0.01, {1, false})), 0);
  const PlacedGroom guessed = place_groom(cm_y_up, "f", {});
  check(guessed, 2);
  EXPECT_THAT(guessed.notes[0], HasSubstr("guessed: cm"));
  EXPECT_THAT(guessed.notes[1], HasSubstr("guessed: y"));
  GroomFile says = cm_y_up;
  says.metres = 0.01;
  says.up = FileAxis{1, false};
  check(place_groom(says, "f", {}), 0);
  // Every choice of axis is a rotation that takes it to z.
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool back : {false, true}) {
      GroomFile axes;
      axes.lines.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
      axes.lines.end_strand(0, 0);
      const Polylines lines = place_groom(axes, "f", placing(1, {axis, back})).lines;
      const Vec x = lines.points[1], y = lines.points[2], z = lines.points[3];
      EXPECT_NEAR(dot(cross(x, y), z), 1, 1e-15);
      EXPECT_EQ(lines.points[static_cast<std::size_t>(axis) + 1].z, back ? -1 : 1);
    }
  }
}

TEST(PlacedGroom, RefusesOrDropsBadStrandsAndSaysSo) {
  const double nan = std::nan("");
  const std::vector<std::pair<std::vector<Vec>, const char*>> bad{
      {{}, "strand 1 has 0 points"},
      {{{1, 1, 1}}, "strand 1 has 1 point"},
      {{{0, 0, 0}, {nan, 0, 1}}, "strand 1 has point 1 that is not finite"},
      {{{0, 0, 0}, {0, 0, 1e30}}, "strand 1 has point 1 1e+30 m away"},
      {{{0, 0, 0}, {0, 0, 0}}, "strand 1 has point 0 twice"}};
  for (const auto& [points, said] : bad) {
    GroomFile read;
    read.metres = 1;
    read.up = FileAxis{2, false};
    read.lines.points = {{0, 0, 1}, {0, 0, 0}};
    read.lines.end_strand(0, 100);
    read.lines.points.insert(read.lines.points.end(), points.begin(), points.end());
    read.lines.end_strand(1, 200);
    EXPECT_THAT(refusal([&] { place_groom(read, "f.hair", {}); }),
                AllOf(HasSubstr(said), HasSubstr("f.hair: byte 200"),
                      HasSubstr("bad_strands = \"drop\"")));
    const PlacedGroom left = place_groom(read, "f.hair", dropping());
    EXPECT_EQ(left.lines.size(), 1u);
    EXPECT_THAT(left.notes.at(0), HasSubstr("left out"));
    EXPECT_EQ(place_groom(read, "f.hair", every_second()).lines.size(), 1u);
  }
  GroomFile twice;
  twice.metres = 1;
  twice.up = FileAxis{2, false};
  twice.lines.points = {{0, 0, 1}, {0, 0, 1}, {0, 0, 0}};
  twice.lines.end_strand(0, 0);
  EXPECT_EQ(place_groom(twice, "f", dropping()).lines.points.size(), 2u);
}

/// Our own exports, of two frames: read again they are the same places, units and axes,
/// at the right times, as thick as they were.
TEST(Exports, AreReadAgain) {
  Scene scene;
  scene.name = "two";
  scene.frame_rate = 24;
  const std::vector<Reading> readings{{"bend", "1/m"}};
  std::vector<Frame3d> frames(2);
  for (std::size_t f = 0; f < 2; ++f) {
    frames[f].series = {static_cast<double>(f) / 8};
    for (const float z : {0.F, 1.F, 2.F, 0.F, 3.F}) {
      frames[f].positions.insert(frames[f].positions.end(),
                                 {0.25F, static_cast<float>(f), z});
      frames[f].channels.push_back(z);
    }
  }
  const std::vector<int> counts{3, 2};
  const SmoothLines curves(counts, frames);
  const std::vector<DrawnLine> lines{{0, 0.01}, {4, 0.03}};
  const Animation animation{scene, readings, readings, lines, frames, curves};
  const auto check = [&](const GroomFile& read, float y) {
    EXPECT_EQ(read.lines.ends, (std::vector<std::size_t>{3, 5}));
    for (std::size_t i = 0; i < 5; ++i) {
      EXPECT_EQ(read.lines.points[i].x, 0.25);
      EXPECT_EQ(read.lines.points[i].y, static_cast<double>(y));
      EXPECT_EQ(read.lines.points[i].z,
                static_cast<double>(frames[0].positions[3 * i + 2]));
    }
  };
  for (std::size_t f = 0; f < 2; ++f) {
    const float y = static_cast<float>(f);
    const std::string drawn = hair(animation, frames[f]);
    check(read_bytes("hair", drawn), y);
    // Thickness of every point, the diameter, at the end of the file.
    float last = 0;
    std::copy_n(drawn.end() - 4, 4, reinterpret_cast<char*>(&last));
    EXPECT_EQ(last, 0.06F);
    const std::string shown = vtp(animation, frames[f]);
    check(read_bytes("vtp", shown), y);
    EXPECT_THAT(shown, HasSubstr(f == 0 ? ">0</DataArray>" : ">0.125</DataArray>"));
  }
  const std::string stage = usda(animation);
  const GroomFile read = read_bytes("usda", stage);
  check(read, 0);
  EXPECT_EQ(read.metres, 1);
  EXPECT_EQ(read.up->axis, 2);
  EXPECT_THAT(
      stage,
      AllOf(HasSubstr("timeCodesPerSecond = 24"), HasSubstr("endTimeCode = 3"),
            HasSubstr("widths = [0.02, 0.06]"), HasSubstr("primvars:strand = [0, 4]"),
            HasSubstr("3: [(0.22, 0.97, -0.03), (0.28, 1.03, 3.03)]")));
}

}  // namespace tress::test_groom_files
