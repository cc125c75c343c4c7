// Pictures for other programs: curves where elements are curved, times, whose line it is,
// and texts that no name of a scene can break.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "simulation/export/smooth_lines.h"
#include "simulation/run/readout.h"
#include "tests/harness/toy_process.h"

namespace tress::test_export {

using namespace simulation;

using testing::HasSubstr;

constexpr double degree = std::numbers::pi / 180;

/// Points `turn` apart (rad) on a helix of radius 4 mm that climbs 10 mm a turn.
struct Curl {
  double turn;
  Vec at(double element) const {
    const double angle = turn * element;
    return {4e-3 * std::cos(angle), 4e-3 * std::sin(angle),
            10e-3 * angle / (2 * std::numbers::pi)};
  }
  Frame3d frame(int elements) const {
    Frame3d frame;
    for (int i = 0; i <= elements; ++i) {
      for (const double c : {at(i).x, at(i).y, at(i).z}) {
        frame.positions.push_back(static_cast<float>(c));
      }
      frame.channels.push_back(static_cast<float>(i));
    }
    return frame;
  }
  double polygon(int elements) const { return elements * norm(at(1) - at(0)); }
};

class CurledLine : public testing::TestWithParam<double> {};

/// Every point lies on the helix and no chord leaves it by more than a thousandth of the
/// length. A polygon of elements of 117 degrees misses it by half its radius.
TEST_P(CurledLine, IsDrawnAsTheHelixItIs) {
  const Curl curl{GetParam() * degree};
  const int elements = 12;
  const Frame3d frame = curl.frame(elements);
  const SmoothLines lines(std::vector{elements + 1}, std::vector{frame});
  const std::vector<float> x = lines.positions(frame);
  const std::vector<float> element = lines.channels(frame);
  ASSERT_EQ(x.size(), 3 * lines.points());
  const auto place = [&x](std::size_t i) { return Vec(load3(&x[3 * i])); };
  ASSERT_EQ(element.size(), lines.points());
  // Positions are rounded to floats of at most 25 mm, half an ulp of 2^-29 m; the turn
  // comes from second differences of these, the smallest of 0.13 mm (10 degrees): 1e-4 of
  // an angle, of which the curve between depends by less than a hundredth of 0.13 mm.
  const double rounding = 1e-8;
  const double allowed = 1e-3 * curl.polygon(elements) + rounding;
  for (std::size_t i = 0; i < lines.points(); ++i) {
    const Vec here = place(i), there = curl.at(static_cast<double>(element[i]));
    EXPECT_LT(norm(here - there), rounding) << element[i];
    if (i == 0) continue;
    const Vec middle = 0.5 * (here + place(i - 1));
    const double between = 0.5 * static_cast<double>(element[i] + element[i - 1]);
    EXPECT_LT(norm(middle - curl.at(between)), allowed);
  }
}

INSTANTIATE_TEST_SUITE_P(Degrees, CurledLine, testing::Values(10.0, 60.0, 117.0, 145.0));

TEST(SmoothLines, CutNothingThatIsStraightAndBearWhatIsDegenerate) {
  Frame3d straight, folded;
  for (const float z : {0.F, 1.F, 2.F, 4.F, 4.5F}) {  // uneven elements
    straight.positions.insert(straight.positions.end(), {0.F, 0.F, z});
  }
  for (const float z : {0.F, 0.F, 1.F, 0.F, 0.F}) {
    folded.positions.insert(folded.positions.end(), {0.F, 0.F, z});
  }
  const SmoothLines plain(std::vector{5}, std::vector{straight});
  EXPECT_EQ(plain.points(), 5U);
  EXPECT_EQ(plain.positions(straight), straight.positions);
  const SmoothLines both(std::vector{5}, std::vector{straight, folded});
  EXPECT_GT(both.points(), 5U);
  for (const float c : both.positions(folded)) EXPECT_TRUE(std::isfinite(c));
}

/// Four hairs with curls of 117 degrees an element, for 75 frames.
std::string curls(const std::string& more = "") {
  std::string scene =
      "title = \"curls\"\nduration_s = 1.5\nframes_per_s = 50\n[integrator]\n"
      "id = \"linearly_implicit_euler\"\ndt_s = 0.02\n[material]\nname = "
      "\"hair.caucasian\"\n[root]\nmotion = \"fixed\"\n[effects.gravity]\n" +
      more;
  for (int k = 0; k < 4; ++k) {
    scene += fmt::format(
        "[[strand]]\nlength_m = 0.1\nelements = 12\nshape = \"helix\"\n"
        "curl_radius_m = 0.004\ncurl_pitch_m = 0.01\nposition_m = [{}, {}, 0]\n",
        k % 2 * 0.02, k < 2 ? 0.0 : 0.02);
  }
  return scene;
}

TEST(Pictures, WithHairsKeepTheTimeAndHaveEveryLineWithRadiusAndStrand) {
  Toy toy;
  toy.write("curls.toml", curls());
  const Toy::Result run =
      toy.run("curls.toml --out out --progress none --hairs 6 --vtk --usd");
  ASSERT_EQ(run.code, 0) << run.err;
  const auto page = nlohmann::json::parse(toy.read("out/curls.json"));
  ASSERT_EQ(page.at("strand_points").size(), 10U);
  EXPECT_EQ(page.at("guides"), 4);
  EXPECT_EQ(page.at("strand_ids"), (std::vector{0, 1, 2, 3, 4, 5, 6, 7, 8, 9}));
  for (const double radius : page.at("radius_m")) {
    EXPECT_GT(radius, 20e-6);
    EXPECT_LT(radius, 60e-6);
  }
  for (const int points : page.at("strand_points")) EXPECT_GT(points, 13);

  // One of every two frames: 1.48 s is frame 74.
  const std::string usda = toy.read("out/curls.usda");
  EXPECT_THAT(usda, HasSubstr("timeCodesPerSecond = 50\n"));
  EXPECT_THAT(usda, HasSubstr("endTimeCode = 74\n"));
  EXPECT_THAT(usda, HasSubstr("\n            72: ["));
  EXPECT_THAT(usda, HasSubstr("\n            74: ["));
  EXPECT_THAT(usda, HasSubstr("primvars:strand = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9]"));

  const std::string vtp = toy.read("out/curls_vtk/curls_00037.vtp");
  EXPECT_THAT(vtp, HasSubstr("NumberOfLines=\"10\""));
  EXPECT_THAT(vtp, HasSubstr("Name=\"radius [m]\""));
  EXPECT_THAT(vtp, HasSubstr("Name=\"strand\""));
  EXPECT_THAT(toy.read("out/curls_vtk/curls.pvd"),
              HasSubstr("timestep=\"1.48\" file=\"curls_00037.vtp\""));
}

/// A word of a binary file.
std::uint32_t word(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// A .glb file's description, and the floats of its accessors.
struct Glb {
  explicit Glb(const std::string& bytes) : text(bytes) {
    EXPECT_EQ(text.substr(0, 4), "glTF");
    EXPECT_EQ(word(text, 8), text.size());
    file = nlohmann::json::parse(text.substr(20, word(text, 12)));
    arrays = 28 + word(text, 12);
    EXPECT_EQ(arrays + file["buffers"][0]["byteLength"].get<std::size_t>(), text.size());
  }
  template <class T>
  std::vector<T> numbers(const nlohmann::json& accessor) const {
    const auto& described = file["accessors"][accessor.get<int>()];
    const auto& view = file["bufferViews"][described["bufferView"].get<int>()];
    std::vector<T> x(view["byteLength"].get<std::size_t>() / sizeof(T));
    std::memcpy(x.data(), text.data() + arrays + view["byteOffset"].get<std::size_t>(),
                sizeof(T) * x.size());
    return x;
  }
  std::vector<float> floats(const nlohmann::json& accessor) const {
    return numbers<float>(accessor);
  }
  std::string text;
  nlohmann::json file;
  std::size_t arrays = 0;
};

TEST(Pictures, OfGltfAreOneMeshWhoseTargetsAreTheLaterFrames) {
  Toy toy;
  toy.write("curls.toml", curls());
  const std::string flags = "curls.toml --out out --progress none --export gltf,vtk";
  ASSERT_EQ(toy.run(flags).code, 0);
  const Glb glb(toy.read("out/curls.glb"));
  const auto& lines = glb.file["meshes"][0]["primitives"][0];
  const auto& sampler = glb.file["animations"][0]["samplers"][0];
  const std::vector<float> times = glb.floats(sampler["input"]);
  ASSERT_EQ(times.size(), 76U);
  EXPECT_EQ(times[74], 1.48F);
  ASSERT_EQ(lines["targets"].size(), 75U);
  const auto weights = glb.numbers<std::uint8_t>(sampler["output"]);
  ASSERT_EQ(weights.size(), 75U * 76U);
  for (std::size_t i = 0; i < weights.size(); ++i) {
    EXPECT_EQ(weights[i], i / 75 == i % 75 + 1 ? 255 : 0);
  }

  // The numbers of a .vtp begin where its points do: the last arrays but two.
  const std::string vtp = toy.read("out/curls_vtk/curls_00074.vtp");
  const std::vector<float> first = glb.floats(lines["attributes"]["POSITION"]);
  const std::vector<float> moved = glb.floats(lines["targets"][73]["POSITION"]);
  const std::string start = "<AppendedData encoding=\"raw\">\n_";
  const std::string places = "NumberOfComponents=\"3\" format=\"appended\" offset=\"";
  const std::size_t offset = std::stoul(vtp.substr(vtp.find(places) + places.size()));
  const std::size_t at = vtp.find(start) + start.size() + offset;
  ASSERT_EQ(word(vtp, at), sizeof(float) * first.size());
  std::vector<float> x(first.size());
  std::memcpy(x.data(), vtp.data() + at + 4, sizeof(float) * x.size());
  // Each of the two roundings is half an ulp of 0.125 m at most.
  for (std::size_t i = 0; i < x.size(); ++i) {
    EXPECT_NEAR(static_cast<double>(first[i] + moved[i]), static_cast<double>(x[i]), 2e-8)
        << i;
  }
  const std::vector<float> strand = glb.floats(lines["attributes"]["_STRAND"]);
  EXPECT_EQ(strand.size(), first.size() / 3);
  EXPECT_EQ(strand.back(), 3.F);
  EXPECT_TRUE(lines["targets"][73].contains("_LOAD_GRAVITY"));
  EXPECT_EQ(glb.file["meshes"][0]["extras"]["attributes"]["_LOAD_GRAVITY"],
            "load gravity [N/m]");
}

/// A short strand beside a long one: each of its own steps, as their mean in the series
/// says; a fixed step is no channel.
TEST(Pictures, HaveTheStepsThatEachStrandChose) {
  const auto scene = [](const std::string& steps) {
    std::string text =
        "title = \"two\"\nduration_s = 0.1\nframes_per_s = 20\n[integrator]\nid = "
        "\"tr_bdf2\"\n" +
        steps + "\n[effects.gravity]\n";
    for (const char* strand : {"length_m = 0.05\nelements = 5", "elements = 6"}) {
      text += fmt::format("[[strand]]\nroot_tangent = [1, 0, 0]\n{}\n", strand);
    }
    return parse_scene(text, "two.toml");
  };
  const Scene chosen = scene("position_tol_rel = 1e-3");
  World world(chosen);
  Readout readout(chosen, world);
  const auto channel = std::ranges::find(readout.channels(), "step", &Reading::name);
  ASSERT_NE(channel, readout.channels().end());
  const auto c = static_cast<std::size_t>(channel - readout.channels().begin());
  const auto column = std::ranges::find(readout.series(), "dt_s", &Reading::name);
  for (std::size_t frame = 0; frame <= 2; ++frame) {
    if (frame > 0) {
      ASSERT_EQ(world.advance(chosen.time_of(frame)), Status::ok);
    }
    const Frame3d read = readout.read(world);
    const std::span<const float> steps =
        std::span(read.channels).subspan(c * readout.points(), readout.points());
    EXPECT_EQ(steps[0], steps[5]);
    EXPECT_EQ(steps[6], steps[12]);
    if (frame == 0) {
      EXPECT_EQ(steps[0], 0.F);
      continue;
    }
    EXPECT_NE(steps[0], steps[6]);
    const auto mean =
        2 / (1 / static_cast<double>(steps[0]) + 1 / static_cast<double>(steps[6]));
    EXPECT_NEAR(mean,
                read.series[static_cast<std::size_t>(column - readout.series().begin())],
                1e-6 * mean);
  }
  const Scene fixed = scene("dt_s = 0.01");
  const World other(fixed);
  const Readout without(fixed, other);
  EXPECT_EQ(std::ranges::count(without.channels(), "step", &Reading::name), 0);
}

TEST(Pictures, HaveTheErrorsThatAreEstimated) {
  Toy toy;
  toy.write("curls.toml", curls());
  ASSERT_EQ(toy.run("curls.toml --out out --progress none --error-bars").code, 0);
  const auto page = nlohmann::json::parse(toy.read("out/curls.json"));
  std::vector<std::string> names;
  for (const auto& channel : page["channels"]) names.push_back(channel["name"]);
  EXPECT_THAT(names, testing::IsSupersetOf({"error in time", "error in space"}));
  ASSERT_EQ(toy.run("curls.toml --out out --progress none").code, 0);
  EXPECT_THAT(toy.read("out/curls.json"), testing::Not(HasSubstr("error in")));
}

TEST(Pictures, RefuseHairsBeforeTheRun) {
  Toy toy;
  toy.write("one.toml", "title = \"one\"\nduration_s = 0.1\n[strand]\n");
  const Toy::Result run = toy.run("one.toml --out out --hairs 5");
  EXPECT_EQ(run.code, 2);
  EXPECT_THAT(run.err, HasSubstr("--hairs"));
  EXPECT_FALSE(toy.exists("out/one.csv"));
}

TEST(Pictures, AndProgressBearAnyName) {
  Toy toy;
  const std::string name = "a\"b&c<d\ne";
  toy.write(
      name + ".toml",
      "title = \"t\"\nduration_s = 0.1\nframes_per_s = 20\n[strand]\nelements = 2\n");
  const Toy::Result run = toy.run("'" + name + ".toml' --out out --progress json --vtk");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(toy.read("out/" + name + "_vtk/" + name + ".pvd"),
              HasSubstr("file=\"a&#34;b&#38;c&#60;d&#10;e_00001.vtp\""));
  std::istringstream lines(run.err);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("{")) continue;
    EXPECT_EQ(nlohmann::json::parse(line).at("scene"), name);
  }
}

}  // namespace tress::test_export
