// Strands of a file as elements: how near they are, how many they need, and that a scene
// starts where its file is, by every model.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "contract/input_error.h"
#include "simulation/files/files.h"
#include "simulation/groom/fitted_groom.h"
#include "simulation/groom/frames.h"
#include "simulation/groom/guide_choice.h"
#include "simulation/groom/random.h"
#include "simulation/head/scene_head.h"
#include "simulation/run/world.h"
#include "simulation/scene_changes/changes.h"
#include "simulation/scene_text/write_scene.h"
#include "tests/support/groom_bytes.h"
#include "tests/support/made_groom.h"

namespace tress::test_file_groom {

using namespace simulation;
using namespace testing_support;
using testing::HasSubstr;

PlacedGroom placed(const MadeGroom& groom) { return {"made", made(groom, 1), {}}; }

double median(std::vector<double> all) {
  std::ranges::sort(all);
  return all[all.size() / 2];
}

SpaceCurve curve_of(std::span<const Vec> points) { return {points, 4, "made"}; }

HelixChain random_chain(int elements, double angle, std::uint64_t seed) {
  Random random(seed, 0);
  HelixChain chain;
  for (int i = 0; i <= elements; ++i) chain.joint.push_back(0.03 * i);
  for (int i = 0; i < elements; ++i) {
    chain.darboux.push_back(angle / 0.03 *
                            Vec{0.3 * random.normal(), random.normal(), random.normal()});
  }
  return chain;
}

/// A curve that is a chain of helices is found to be it: the sum that the fit makes small
/// is, for the true chain, that of the two weights, which bounds the distance of the
/// fitted one. Its steps end where one gains less than a thousandth.
TEST(FitHelices, FindsAChainOfHelices) {
  for (const double angle : {0.0, 0.2, 0.7}) {
    const HelixChain chain = random_chain(6, angle, 5);
    std::vector<double> arcs;
    for (int i = 0; i <= 300; ++i) arcs.push_back(0.18 * i / 300);
    const SpaceCurve curve = curve_of(places_on(chain, arcs));
    const HelixChain found = fit_helices(curve, chain.joint);
    const double bound = misfit(curve, chain);
    EXPECT_LE(misfit(curve, found), bound * 1.002 + 1e-20) << angle;
    EXPECT_LE(distance(curve, found, Between::helices).rms,
              0.18 * std::sqrt(bound) + 1e-9)
        << angle;
    EXPECT_LT(bound, 1e-4);
  }
}

/// No chain nearby has a smaller sum than by what the fit stops at, a thousandth; from
/// its start, which has none of the steps, one in two has.
TEST(FitHelices, EndsAtTheLeastSum) {
  const Polylines lines = made(curls(), 1);
  const SpaceCurve curve = curve_of(lines.strand(3));
  const HelixChain found = fit_helices(curve, cut_equally(curve.length(), 8));
  const double least = misfit(curve, found);
  Random random(3, 1);
  int better_far_away = 0;
  for (int i = 0; i < 200; ++i) {
    HelixChain other = found, away = found;
    const double size = std::pow(10.0, -1 - i % 4);  // rad of an element
    for (std::size_t k = 0; k < other.darboux.size(); ++k) {
      const double l = other.joint[k + 1] - other.joint[k];
      const Vec change =
          size / l * Vec{random.normal(), random.normal(), random.normal()};
      other.darboux[k] = other.darboux[k] + change;
      away.darboux[k] = 1.2 * away.darboux[k];
    }
    EXPECT_GE(misfit(curve, other), (1 - 2e-3) * least);
    HelixChain beside = away;
    for (std::size_t k = 0; k < other.darboux.size(); ++k) {
      beside.darboux[k] =
          beside.darboux[k] + 1e-2 * (other.darboux[k] - found.darboux[k]);
    }
    better_far_away += misfit(curve, beside) < misfit(curve, away) ? 1 : 0;
  }
  EXPECT_GT(better_far_away, 50);
}

/// Hair over the forehead turns by some two radians.
TEST(FitHelices, OfBangsAreNear) {
  const PlacedGroom groom = placed(bangs());
  std::vector<double> rms;
  for (std::size_t k = 0; k < groom.lines.size(); ++k) {
    const FittedStrand one = fitted(groom, k, {.elements = 8});
    rms.push_back(one.error.rms / one.length());
    EXPECT_EQ(one.elements(), 8);
  }
  EXPECT_LE(median(rms), 0.12e-2);
}

TEST(CutByTurning, SharesLengthAndTurning) {
  const Polylines lines = made(ponytail(), 1);
  const SpaceCurve curve = curve_of(lines.strand(0));
  const std::vector<double> turned = turning(curve);
  for (const int n : {1, 2, 7, 40}) {
    const std::vector<double> joints = cut_by_turning(curve, turned, n);
    ASSERT_EQ(joints.size(), static_cast<std::size_t>(n) + 1);
    EXPECT_EQ(joints.back(), curve.length());
    for (std::size_t k = 0; k + 1 < joints.size(); ++k) {
      const double l = joints[k + 1] - joints[k];
      EXPECT_GT(l, 0);
      EXPECT_LE(l, 2 * curve.length() / n * (1 + 1e-12));
    }
  }
  const std::vector<Vec> straight{{0, 0, 0}, {1, 0, 0}, {4, 0, 0}};
  const SpaceCurve line = curve_of(straight);
  EXPECT_NEAR(cut_by_turning(line, turning(line), 4)[1], 1, 1e-12);
}

/// The number of elements that the turning asks for is enough for 1 % of the length, the
/// largest distance of any point, on 90 % of the strands of each groom; with a tolerance
/// all are within, as edges too.
TEST(FittedGroom, HasElementsByTurning) {
  for (const MadeGroom& hair : {bangs(), curls(), ponytail()}) {
    const PlacedGroom groom = placed(hair);
    const FittedGroom fit =
        fit_groom(groom, groom.lines.size(), {.elements = 80, .tolerance_rel = 0.01}, 2);
    std::size_t enough = 0;
    for (const FittedStrand& one : fit.strands) {
      EXPECT_EQ(one.by_rule, elements_by_turning(one.turning, 0.01));
      EXPECT_LE(one.error.largest, 0.01 * one.length());
      enough += one.rule_holds ? 1 : 0;
    }
    RecordProperty(std::to_string(hair.length) + "m", std::to_string(enough));
    EXPECT_GE(10 * enough, 9 * fit.strands.size()) << hair.length;
    EXPECT_THAT(fit.notes.back(), HasSubstr("strands fitted"));
  }
  const PlacedGroom groom = placed(ponytail());
  const FittedGroom edges = fit_groom(
      groom, 10, {.elements = 80, .tolerance_m = 2e-3, .between = Between::edges}, 1);
  for (const FittedStrand& one : edges.strands) EXPECT_LE(one.error.largest, 2e-3);
}

TEST(FittedGroom, DoesNotDependOnThreads) {
  const PlacedGroom groom = placed(curls());
  const FittedGroom one = fit_groom(groom, 20, {.elements = 6}, 1);
  const FittedGroom three = fit_groom(groom, 20, {.elements = 6}, 3);
  for (std::size_t k = 0; k < 20; ++k) {
    EXPECT_EQ(one.strands[k].number, 5 * k);
    EXPECT_EQ(one.strands[k].error.rms, three.strands[k].error.rms);
  }
}

/// A scene in a folder of its own, with a groom of nine hairs beside it.
class FileGroomScene : public testing::Test {
 protected:
  FileGroomScene()
      : folder_(testing::TempDir() + "file_groom_" + std::to_string(getpid()) + "/") {
    std::filesystem::create_directories(folder_);
    MadeGroom groom = bangs();
    groom.locks = groom.hairs = 3;
    lines_ = made(groom, 2);
    replace_file(folder_ + "nine.hair", groom_bytes("hair", lines_));
  }
  ~FileGroomScene() override { std::filesystem::remove_all(folder_); }

  std::string text(const std::string& keys, const std::string& more = "") const {
    return "title = \"t\"\n[groom]\nfile = \"nine.hair\"\nelements = 8\n" + keys + "\n" +
           more;
  }
  Scene scene(const std::string& keys, const std::string& more = "") const {
    return parse_scene(text(keys, more), folder_ + "scene.toml");
  }
  std::string refusal(const std::string& keys, const std::string& more = "") const {
    try {
      scene(keys, more);
    } catch (const InputError& error) {
      return error.what();
    }
    return "nothing refused";
  }
  /// Largest distance of points of strand k from the points of the file, over its length.
  double away(std::span<const Vec> points, std::size_t k) const {
    double most = 0;
    const std::span<const Vec> file = lines_.strand(k);
    for (const Vec& x : points) {
      double least = 1;
      for (const Vec& y : file) least = std::min(least, norm(x - y));
      most = std::max(most, least);
    }
    return most / curve_of(file).length();
  }

  std::string folder_;
  Polylines lines_;
};

const std::string as_it_is = "unit = \"m\"\nup = \"z\"";

TEST_F(FileGroomScene, StartsWhereItsFileIs) {
  const Scene read = scene(as_it_is);
  ASSERT_EQ(read.strands.size(), 9u);
  ASSERT_EQ(read.fitted.size(), 1u);
  for (std::size_t k = 0; k < 9; ++k) {
    const Strand& strand = read.strands[k];
    EXPECT_EQ(strand.segments.size(), 8u);
    EXPECT_LE(norm(strand.root.position - lines_.strand(k)[0]), 1e-7);
    // Points of the file are up to 2 % of the length apart.
    EXPECT_LE(away(initial_points(strand), k), 0.015);
    for (const Segment& segment : strand.segments) {
      EXPECT_EQ(norm(segment.natural - segment.initial), 0);
    }
  }
  EXPECT_EQ(
      norm(scene("initial = \"straight\"\nunit = \"m\"").strands[0].segments[0].initial),
      0);
  // Its file is found from its folder, when it is written, too.
  const Scene again = parse_scene(scene_text(read), "elsewhere.toml");
  EXPECT_EQ(
      norm(again.strands[8].segments[7].natural - read.strands[8].segments[7].natural),
      0);
}

/// Every model of a strand, clamped to a head that moves or free, with effects or none,
/// starts with its points on the file; or says what it cannot do.
TEST_F(FileGroomScene, IsForEveryModel) {
  int taken = 0;
  const std::string few_of_them = fmt::format("{}\nevery = 4", as_it_is);
  for (const ModelEntry& model : model_catalogue()) {
    if (model.on_strand == nullptr) continue;
    for (const char* motion : {"shake", "free", "head"}) {
      for (const char* effects : {"", "[effects.gravity]\n[effects.quadratic_drag]\n"}) {
        SCOPED_TRACE(fmt::format("{} {} {}", model.id, motion, effects));
        const std::string more = fmt::format(
            "[model]\nid = \"{}\"\n[integrator]\nid = \"backward_euler\"\n[root]\n"
            "motion = \"{}\"\n{}",
            model.id, motion, effects);
        const std::string said = refusal(few_of_them, more);
        if (said != "nothing refused") {
          EXPECT_THAT(said, HasSubstr("scene.toml:"));
          continue;
        }
        ++taken;
        World world(scene(few_of_them, more));
        std::size_t first = 0;
        for (std::size_t k = 0; k < world.points().size(); ++k) {
          std::vector<Vec> points;
          for (int i = 0; i < world.points()[k]; ++i, ++first) {
            points.push_back(load3(&world.positions()[3 * first]));
          }
          // Splines go near their control points: some percent for eight of them.
          EXPECT_LE(away(points, 4 * k), 0.05);
        }
      }
    }
  }
  EXPECT_GE(taken, 30);
}

TEST_F(FileGroomScene, IsThinnedCutAndGuided) {
  const std::string& keys = as_it_is;
  EXPECT_EQ(scene(keys + "\nevery = 2").strands.size(), 5u);
  EXPECT_EQ(scene(keys + "\ncount = 4").strands.size(), 4u);
  const Scene guided = scene(keys + "\nguides = 3");
  EXPECT_EQ(guided.strands.size(), 3u);
  EXPECT_EQ(guided.followers.size(), 6u);
  EXPECT_EQ(with_elements(guided, 5).strands[0].segments.size(), 5u);
  EXPECT_EQ(with_twice_the_elements(guided).fitted[0]->strands[0].elements(), 16);
  EXPECT_EQ(every_strand(guided, 6).strands.size(), 6u);
  const Scene detailed = scene(keys + "\nfit_tolerance = 0.01");
  EXPECT_LT(detailed.strands[0].segments.size(), 8u);
  EXPECT_EQ(with_elements(detailed, 5).strands[3].segments.size(), 5u);
  EXPECT_THAT(scene(keys + "\nposition_m = [0, 0, 2]").strands[0].root.position.z,
              testing::DoubleNear(2 + lines_.points[0].z, 1e-6));
  const Scene inches = scene("unit = \"inch\"\nup = \"z\"");
  EXPECT_NEAR(inches.strands[0].length(), 0.0254 * scene(keys).strands[0].length(), 1e-9);
}

TEST_F(FileGroomScene, HasLanesWithEqualElements) {
  const auto outline = [&](const std::string& keys) {
    const std::string file = folder_ + "head.toml";
    replace_file(file, text(as_it_is + keys,
                            "[model]\njacobian = \"elastic\"\n[integrator]\nid = "
                            "\"linearly_implicit_euler\"\n"));
    return read_outline(file);
  };
  const auto no = no_lanes(outline("").scene);
  ASSERT_TRUE(no);
  EXPECT_THAT(no->remedy, HasSubstr("mesh = \"equal\""));
  EXPECT_FALSE(no_lanes(outline("\nmesh = \"equal\"").scene));
}

TEST_F(FileGroomScene, RefusesKeysThatDoNothing) {
  EXPECT_THAT(refusal("length_m = 0.1"),
              HasSubstr("length_m cannot be combined with file"));
  EXPECT_THAT(refusal("grading = 2"), HasSubstr("grading cannot be combined with file"));
  EXPECT_THAT(refusal("shape = \"wavy\""),
              HasSubstr("shape cannot be combined with file"));
  EXPECT_THAT(refusal("unit = \"m\"\nunit_m = 2"),
              HasSubstr("unit_m cannot be combined with unit"));
  EXPECT_THAT(refusal("count = 10"), HasSubstr("10 of the 9 strands"));
  EXPECT_THAT(refusal("guides = 2\nfit_tolerance = 0.1"),
              HasSubstr("all guide strands must have the same number"));
  for (const char* key :
       {"unit = \"m\"", "every = 2", "mesh = \"equal\"", "fit_tolerance = 1"}) {
    try {
      parse_scene(fmt::format("title = \"t\"\n[groom]\n{}\n", key), "s.toml");
      ADD_FAILURE() << key;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("has no effect without file"));
    }
  }
}

const std::string ponytail_file = TRESS_SCENES "/groomed_ponytail.hair";

/// Run it with --gtest_also_run_disabled_tests to write the file anew.
TEST(GroomedPonytail, DISABLED_WritesThePonytail) {
  replace_file(ponytail_file, groom_bytes("hair", made(ponytail(), 1)));
}

TEST(GroomedPonytail, IsWhatItsProgramMakes) {
  const Polylines lines = made(ponytail(), 1);
  const Polylines read = read_groom(ponytail_file).lines;
  ASSERT_EQ(read.points.size(), lines.points.size());
  for (std::size_t i = 0; i < lines.points.size(); ++i) {
    EXPECT_LE(norm(read.points[i] - lines.points[i]), 1e-6);
  }
}

}  // namespace tress::test_file_groom
