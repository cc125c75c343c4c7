// Scenes that run as one head of hair: the program `simulate` as its users run it, and
// what the head is beside strands that run one by one.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "contract/input_error.h"
#include "integrators/block/block_method.h"
#include "models/motion/root_motion.h"
#include "simulation/export/head_frames.h"
#include "simulation/files/csv.h"
#include "simulation/head/head_guard.h"
#include "simulation/head/head_run.h"
#include "simulation/head/no_head.h"
#include "simulation/head/scene_head.h"
#include "simulation/run/world.h"
#include "simulation/scene/strand_tables.h"
#include "tests/harness/toy_process.h"
#include "tests/models/head/arrangements.h"
#include "tests/support/apart.h"

namespace tress::test_head {

using namespace simulation;

using testing::HasSubstr;

struct Hair {
  int count = 21, elements = 6;
  std::string top = "duration_s = 0.2\nframes_per_s = 20\n";
  std::string model = "id = \"super_helix\"\njacobian = \"elastic\"\n";
  std::string integrator = "id = \"linearly_implicit_euler\"\ndt_s = 0.004\n";
  std::string groom = "";
  std::string root = "motion = \"rotate\"\naxis = [0, 0, 1]\nangle_rad = 0.5\n";
  std::string more = "[effects.gravity]\n[effects.linear_drag]\n";
};

std::string text(const Hair& h) {
  return fmt::format(
      "title = \"head\"\n{}[model]\n{}[integrator]\n{}[material]\n"
      "name = \"hair.caucasian\"\n[groom]\ncount = {}\nelements = {}\nlength_m = 0.1\n"
      "{}[root]\n{}{}",
      h.top, h.model, h.integrator, h.count, h.elements, h.groom, h.root, h.more);
}

constexpr const char* as_head = "head.toml --as batch --out out --progress none ";

/// Runs it; the result must be `code`.
Toy::Result run(Toy& toy, const std::string& options, int code = 0) {
  Toy::Result result = toy.run(as_head + options);
  EXPECT_EQ(result.code, code) << result.err;
  return result;
}

nlohmann::json outcome(const Toy& toy) {
  return nlohmann::json::parse(toy.read("out/head.meta.json")).at("outcome");
}

std::string path(const Toy& toy, const std::string& name) {
  return (std::filesystem::path(toy.path("work")) / name).string();
}

/// All rows of a dataset, in 64 bits.
std::vector<double> all_of(const Hdf5File& file, const std::string& dataset) {
  const std::vector<std::size_t> size = file.size(dataset);
  std::size_t numbers = 1;
  for (const std::size_t n : size) numbers *= n;
  std::vector<double> x(numbers);
  if (numbers > 0) file.read(dataset, 0, std::span(x));
  return x;
}

/// Of all strands in all frames.
std::vector<double> positions_of(const Hdf5File& file) {
  std::vector<double> all;
  for (std::size_t frame = 0; file.has(HeadFrames::dataset(frame)); ++frame) {
    const std::vector<double> one = all_of(file, HeadFrames::dataset(frame));
    all.insert(all.end(), one.begin(), one.end());
  }
  return all;
}

constexpr models::HeadNumber all_numbers[] = {models::HeadNumber::float64,
                                              models::HeadNumber::float32};
/// Every number of lanes, and of one every number of threads. The lanes decide how many
/// blocks there are; threads take blocks as they come.
std::vector<std::pair<int, int>> lanes_and_threads(models::HeadNumber number) {
  const int longest = models::longest_pack(number).lanes;
  std::vector<std::pair<int, int>> all{{longest, 2}, {longest, 3}};
  for (const models::HeadPack& pack : testing_support::packs_of_build()) {
    if (pack.number == number) all.push_back({pack.lanes, 1});
  }
  return all;
}

TEST(HeadOfHair, IsTheSameBitsForAnyNumberOfThreadsAndLanes) {
  Toy toy;
  // More than one chunk of frames.
  toy.write("head.toml", text({.count = 2100, .elements = 3}));
  for (const models::HeadNumber number : all_numbers) {
    const int bits = number == models::HeadNumber::float64 ? 64 : 32;
    std::string series, state;
    std::vector<double> positions;
    for (const auto& [lanes, threads] : lanes_and_threads(number)) {
      run(toy, fmt::format("--precision {} --simd-width {} --threads {}", bits, lanes,
                           threads));
      const Hdf5File file(path(toy, "out/head.h5"), Hdf5File::Mode::read);
      const auto meta = outcome(toy);
      EXPECT_EQ(meta.at("simd_width"), lanes);
      EXPECT_EQ(meta.at("precision"), bits);
      if (state.empty()) {
        series = toy.read("out/head.csv");
        state = meta.at("state_hash");
        positions = positions_of(file);
        EXPECT_EQ(positions.size(), 5U * 2100 * 4 * 3);
      }
      EXPECT_EQ(toy.read("out/head.csv"), series) << lanes << ' ' << threads;
      EXPECT_EQ(meta.at("state_hash"), state) << lanes << ' ' << threads;
      EXPECT_EQ(positions_of(file), positions) << lanes << ' ' << threads;
    }
  }
}

struct Acting {
  std::string name, more;
};
void PrintTo(const Acting& a, std::ostream* out) { *out << a.name; }  // NOLINT
/// Models whose heads take all effects.
constexpr const char* models_in_all[] = {"super_helix", "super_clothoid",
                                         "articulated_chain"};
/// Those whose heads have all methods, and their tables with the exact Jacobian.
constexpr const char* models_by_all[] = {"super_helix", "super_clothoid",
                                         "articulated_chain", "mass_spring", "corde"};
std::string exact(const std::string& model, int points) {
  return model == "mass_spring" || model == "corde" || model == "der"
             ? fmt::format("id = \"{}\"\n", model)
             : fmt::format("id = \"{}\"\nquadrature = {}\n", model, points);
}
/// Of how many kinds of numbers a head can be by a method.
std::size_t numbers_of(const std::string& model, const std::string& method) {
  return model == "mass_spring" || ((model == "articulated_chain" || model == "corde") &&
                                    method == "linearly_implicit_midpoint")
             ? 1
             : 2;
}
std::string stiff(const std::string& model) {
  return "id = \"" + model + "\"\njacobian = \"elastic\"\n";
}
class HeadUnder : public testing::TestWithParam<std::tuple<Acting, const char*>> {};

/// Of any number of threads and lanes; `look` at one of the heads of each kind of number.
void expect_the_same_bits(const SceneOutline& outline, int steps, double h,
                          std::span<const models::HeadNumber> numbers,
                          const std::function<void(const Head&)>& look) {
  for (const models::HeadNumber number : numbers) {
    std::optional<std::size_t> want;
    for (const auto& [lanes, threads] : lanes_and_threads(number)) {
      SceneHead made = make_head(outline, {number, lanes}, threads);
      HeadRun head(std::move(made.head), threads, std::move(made.interaction));
      for (int s = 0; s < steps; ++s) head.step(s * h, h);
      if (!want) {
        want = head.head().hash();
        look(head.head());
      }
      EXPECT_EQ(head.head().hash(), *want) << lanes << " lanes, " << threads;
    }
  }
}

constexpr const char* turning =
    "motion = \"rotate\"\naxis = [0, 0.6, 0.8]\nangle_rad = 1\nfrequency_hz = 5\n";

// Elements wind, and joints turn, by some 1.4 rad at rest, so that strands beside each
// other, and soon the same strand, need other formulas than the one that most of a head's
// do.
TEST_P(HeadUnder, IsTheSameBitsForAnyNumberOfThreadsAndLanes) {
  constexpr int elements = 3, count = 22;
  const auto& [acting, model] = GetParam();
  const bool joints = std::string(model) == "articulated_chain";
  const std::size_t each = std::string(model) == "super_clothoid" ? 6 : 3;
  const double radians = joints ? 1 : 0.1 / elements;
  const SceneOutline outline = parse_outline(
      text({.count = count,
            .elements = elements,
            .model = stiff(model),
            .groom = "shape = \"helix\"\ncurl_radius_m = 0.023\ncurl_pitch_m = 0.01\n"
                     "curl_variation = 0.5\n",
            .root = turning,
            .more = acting.more}),
      "head.toml");
  expect_the_same_bits(outline, 40, 0.001, all_numbers, [&](const Head& head) {
    int wound = 0, all = 0;
    std::vector<double> q(each * elements), v(q.size());
    for (std::size_t k = 0; k < count; ++k) {
      if (head.lost(k)) continue;
      head.state(k, q, v);
      for (std::size_t i = 0; i < elements; ++i, ++all) {
        wound += norm(load3(&q[each * i])) * radians > 1.5 ? 1 : 0;
      }
    }
    EXPECT_GE(wound, 3);  // or this says little
    EXPECT_GE(all - wound, 3);
  });
}

constexpr const char* air_and_weight =
    "[effects.gravity]\n[effects.linear_drag]\ndrag_kg_m_s = 1e-4\n";
constexpr const char* ellipsoid =
    "[effects.body]\nshape = \"ellipsoid\"\nhalf_axes_m = [0.11, 0.1, 0.13]\n";
constexpr const char* interaction =
    "[effects.strand_interaction]\nouter_radius_m = 0.03\n";

INSTANTIATE_TEST_SUITE_P(
    Effects, HeadUnder,
    testing::Combine(
        testing::Values(
            Acting{"Gravity", "[effects.gravity]\n"}, Acting{"Drag", air_and_weight},
            Acting{"Wind", std::string(air_and_weight) + "[effects.wind]\n"},
            Acting{"ABodyAtRest", std::string(air_and_weight) + ellipsoid},
            Acting{"ABodyThatMoves",
                   std::string(air_and_weight) + ellipsoid + "moves = \"head\"\n"},
            Acting{"Interaction", std::string(air_and_weight) + interaction},
            Acting{"All", std::string(air_and_weight) + "[effects.wind]\n" + ellipsoid +
                              "moves = \"head\"\n" + interaction}),
        testing::ValuesIn(models_in_all)),
    [](const auto& of) {
      return std::get<0>(of.param).name + "_" + std::get<1>(of.param);
    });

TEST(HeadOfHair, OfSpringsIsTheSameBitsForAnyNumberOfThreadsAndLanes) {
  for (const bool moves : {false, true}) {
    const SceneOutline outline =
        parse_outline(text({.count = 22,
                            .model = "id = \"mass_spring\"\njacobian = \"filtered\"\n",
                            .root = turning,
                            .more = std::string(air_and_weight) + ellipsoid +
                                    (moves ? "moves = \"head\"\n" : "")}),
                      "head.toml");
    expect_the_same_bits(outline, 40, 0.001, std::span(all_numbers).first(1),
                         [](const Head& head) { EXPECT_TRUE(head.losses().empty()); });
  }
}

/// Positions of all strands at the end, by a World whose start differs by `change`.
std::vector<double> by_world(const Scene& scene, double change) {
  World world(scene);
  // Of curvatures, of the angles of joints, and of the lengths of edges.
  const double size = scene.model->id == "articulated_chain" ? 0.2
                      : steps_edges(scene)                   ? 0.01
                                                             : 10;
  Snapshot start = world.snapshot();
  for (auto& strand : start.strands) {
    for (std::size_t i = 0; i < strand.q.size(); ++i) {
      strand.q[i] += (i % 2 == 0 ? change : -change) * (std::abs(strand.q[i]) + size);
    }
  }
  world.restore(start);
  for (std::size_t frame = 1; frame <= scene.last_frame(); ++frame) {
    EXPECT_EQ(world.advance(scene.time_of(frame)), Status::ok);
  }
  return world.positions();
}

// As for single strands (tests/models/head/test_reduced_head.cpp): some thousand
// roundings an element, that are amplified as any change of the start is, differ by less
// than one of so much makes.
double rounding(const Scene& scene) {
  return scene.model->id == "articulated_chain" ? 3e-11 : 1e-12;
}

TEST(HeadOfHair, MovesAsTheWorldOfTheSceneDoes) {
  for (const std::string options :
       {"id = \"super_helix\"\nquadrature = 8\n",
        "id = \"super_helix\"\nquadrature = 8\nmodes = \"bend\"\n",
        "id = \"super_clothoid\"\nquadrature = 8\n",
        "id = \"super_clothoid\"\nquadrature = 8\nmodes = \"bend\"\n",
        "id = \"articulated_chain\"\n", "id = \"articulated_chain\"\nmodes = \"bend\"\n",
        "id = \"articulated_chain\"\nrotary_inertia = \"off\"\nmodes = \"bend\"\n"}) {
    SCOPED_TRACE(options);
    Toy toy;
    toy.write("head.toml", text({.count = 8,
                                 .model = options + "jacobian = \"elastic\"\n",
                                 .more = "[effects.gravity]\n[effects.linear_drag]\n"
                                         "mass_damping_per_s = 0.3\n"}));
    const Scene scene = read_scene(path(toy, "head.toml"));
    const std::vector<double> want = by_world(scene, 0);
    run(toy, "--frames 64");
    const Hdf5File file(path(toy, "out/head.h5"), Hdf5File::Mode::read);
    const std::vector<double> first = all_of(file, HeadFrames::dataset(0)),
                              end = all_of(file, HeadFrames::dataset(4));
    ASSERT_EQ(end.size(), want.size());
    EXPECT_LE(apart(end, want), apart(by_world(scene, rounding(scene)), want));
    EXPECT_GT(apart(first, want), 1e-3);  // it has moved, or this says nothing
  }
}

/// On stiffer bodies single corrections, of the world's strands as well, gain energy.
constexpr const char* soft = "moves = \"head\"\nstiffness_n_m2 = 0.1\n";

/// Integrators with the exact Jacobian, and the Newton's tolerances that a step of each
/// leaves at most, of so many first steps (tests/models/head/exact_methods.h).
struct Exact {
  const char* integrator;
  double left;
  int solved;
};
void PrintTo(const Exact& e, std::ostream* out) { *out << e.integrator; }  // NOLINT
constexpr Exact exact_methods[] = {{"backward_euler", 1, 1000},
                                   {"linearly_implicit_midpoint", 1, 2},
                                   {"tr_bdf2", 7, 1000}};
/// Single corrections must resolve the stretch of edges.
double step_of(const std::string& model, const std::string& method) {
  return (model == "mass_spring" || model == "corde") &&
                 method == "linearly_implicit_midpoint"
             ? 1e-4
             : 1e-3;
}
/// A model, a method, and whether a body touches the hairs.
class HeadBy : public testing::TestWithParam<std::tuple<const char*, Exact, bool>> {
 protected:
  static Hair hair(bool touched) {
    const auto& [model, method, any] = GetParam();
    return {.count = 20,
            .top = "duration_s = 0.1\nframes_per_s = 20\n",
            .model = exact(model, 8),
            .integrator = fmt::format("id = \"{}\"\ndt_s = {}\n", method.integrator,
                                      step_of(model, method.integrator)),
            .more = std::string(air_and_weight) +
                    (touched ? std::string(ellipsoid) + soft : "")};
  }
};

TEST_P(HeadBy, IsTheSameBitsForAnyNumberOfThreadsAndLanes) {
  Hair own = hair(std::get<2>(GetParam()));
  own.root = turning;
  const auto& [model, method, touched] = GetParam();
  expect_the_same_bits(parse_outline(text(own), "head.toml"), 20, 0.001,
                       std::span(all_numbers).first(numbers_of(model, method.integrator)),
                       [](const Head& head) { EXPECT_TRUE(head.losses().empty()); });
}

TEST_P(HeadBy, MovesAsTheWorldOfTheSceneDoes) {
  const auto& [model, method, touched] = GetParam();
  Toy toy;
  toy.write("head.toml", text(hair(touched)));
  const Scene scene = read_scene(path(toy, "head.toml"));
  const std::vector<double> want = by_world(scene, 0);
  run(toy, "--frames 64 --threads 2");
  const Hdf5File file(path(toy, "out/head.h5"), Hdf5File::Mode::read);
  const double left = std::min(100, method.solved) * method.left * 1e-10;
  EXPECT_LE(apart(all_of(file, HeadFrames::dataset(2)), want),
            apart(by_world(scene, rounding(scene) + left), want) + left * 0.1);
  // What it does and what touches it are seen.
  Toy bare;
  bare.write("head.toml", text(hair(!touched)));
  EXPECT_GT(apart(by_world(read_scene(path(bare, "head.toml")), 0), want), 1e-6);
  EXPECT_GT(apart(all_of(file, HeadFrames::dataset(0)), want), 1e-3);
}

std::string name_of(const testing::TestParamInfo<HeadBy::ParamType>& of) {
  const auto& [model, method, touched] = of.param;
  return fmt::format("{}_{}{}", model, method.integrator, touched ? "_on_a_body" : "");
}
// Those on a body move without one as well: alone, where they take the least time, and
// `More`.
INSTANTIATE_TEST_SUITE_P(OnABody, HeadBy,
                         testing::Combine(testing::ValuesIn(models_by_all),
                                          testing::ValuesIn(exact_methods),
                                          testing::Values(true)),
                         name_of);
INSTANTIATE_TEST_SUITE_P(Free, HeadBy,
                         testing::Combine(testing::Values("super_helix", "corde"),
                                          testing::ValuesIn(exact_methods),
                                          testing::Values(false)),
                         name_of);
INSTANTIATE_TEST_SUITE_P(More, HeadBy,
                         testing::Combine(testing::Values("super_clothoid",
                                                          "articulated_chain",
                                                          "mass_spring"),
                                          testing::ValuesIn(exact_methods),
                                          testing::Values(false)),
                         name_of);

// By one correction der is replicated.
INSTANTIATE_TEST_SUITE_P(Rods, HeadBy,
                         testing::Combine(testing::Values("der"),
                                          testing::Values(exact_methods[0],
                                                          exact_methods[2]),
                                          testing::Bool()),
                         name_of);

Hair controlled(const char* model, double tolerance) {
  return {
      .model = exact(model, 4),
      .integrator = fmt::format("id = \"tr_bdf2\"\nposition_tol_rel = {}\n", tolerance),
      .more = air_and_weight};
}

TEST(HeadWithATolerance, IsTheSameBitsForAnyNumberOfThreadsAndLanes) {
  for (const char* model : std::span(models_by_all).first(3)) {
    Hair own = controlled(model, 1e-2);
    own.count = 20;
    own.root = turning;
    own.more = std::string(air_and_weight) + ellipsoid + soft;
    expect_the_same_bits(parse_outline(text(own), "head.toml"), 4, 0.05,
                         std::span(all_numbers).first(numbers_of(model, "tr_bdf2")),
                         [](const Head& head) { EXPECT_TRUE(head.losses().empty()); });
  }
}

// Both take steps that leave share tolerance^power of the length at most each; those of
// the head are a half at least of what the same control asks for, so at most twice as
// many. What they leave grows as a change of the start does.
TEST(HeadWithATolerance, MovesAsTheWorldOfTheSceneDoes) {
  for (const char* model : std::span(models_by_all).first(3)) {
    SCOPED_TRACE(model);
    constexpr double tolerance = 1e-4, length = 0.1;
    Toy toy;
    toy.write("head.toml", text(controlled(model, tolerance)));
    const Scene scene = read_scene(path(toy, "head.toml"));
    World world(scene);
    for (std::size_t frame = 1; frame <= scene.last_frame(); ++frame) {
      ASSERT_EQ(world.advance(scene.time_of(frame)), Status::ok);
    }
    const std::vector<double> want = world.positions();
    constexpr double change = 1e-6;
    const double grown =
        std::max(1.0, apart(by_world(scene, change), want) / (change * length));
    const double left = integrators::tr_bdf2_estimate.threshold(tolerance) * length *
                        grown * static_cast<double>(std::ranges::max(world.steps()));
    const Toy::Result result = run(toy, "--frames 64 --threads 2");
    EXPECT_THAT(result.err, HasSubstr("rejected by their error"));
    const Hdf5File file(path(toy, "out/head.h5"), Hdf5File::Mode::read);
    const std::vector<double> end = all_of(file, HeadFrames::dataset(4));
    EXPECT_LE(apart(end, want), 3 * left);
    EXPECT_NE(apart(end, want), 0);
    EXPECT_GT(apart(all_of(file, HeadFrames::dataset(0)), want), 10 * left);
    // Steps of strands, whose mean is that of the world's or up to twice as many.
    const auto meta = outcome(toy);
    const long steps = meta.at("steps"), of_world = world.stats().steps;
    EXPECT_GE(2 * steps, of_world);
    EXPECT_LE(steps, 2 * of_world);
    EXPECT_GT(meta.at("newton_iterations"), 2 * steps);
    EXPECT_GE(meta.at("rejected_by_error"), 0);
    EXPECT_EQ(meta.at("failed_strands"), 0);
  }
}

TEST(HeadWithATolerance, IsTakenFromAThousandStrandsOn) {
  Toy toy;
  Hair many = controlled("super_helix", 1e-2);
  many.count = 1000;
  many.elements = 3;
  toy.write("head.toml", text(many));
  const auto result = toy.run("head.toml --out out --progress none");
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(outcome(toy).at("strands"), 1000);
  EXPECT_GE(outcome(toy).at("steps"), 4 * 1000);
}

TEST(HeadWithATolerance, NamesStrandsThatNeedShorterStepsThanAllowed) {
  Toy toy;
  Hair hair = controlled("super_helix", 1e-3);
  hair.integrator += "min_step_s = 0.01\n";
  toy.write("head.toml", text(hair));
  run(toy, "", 3);
  const CsvTable lost = parse_csv(toy.read("out/head.failed.csv"), "csv");
  EXPECT_GT(lost.rows.size(), 0U);
  EXPECT_EQ(outcome(toy).at("failed_strands"), lost.rows.size());
  EXPECT_GE(outcome(toy).at("rejected_by_error"), lost.rows.size());
}

// The same with what else acts; each of it moves the hairs by more than a micrometre.
TEST(HeadOfHair, MovesAsTheWorldUnderItsEffects) {
  const std::string air =
      "[effects.gravity]\n[effects.linear_drag]\ndrag_kg_m_s = 1e-4\n";
  for (const char* model : models_in_all) {
    SCOPED_TRACE(model);
    // By longer steps rigid links come apart on a body, and clothoids gain energy there,
    // as the world's do.
    const double dt = std::string(model) == "articulated_chain" ? 0.00025
                      : std::string(model) == "super_clothoid"  ? 0.001
                                                                : 0.004;
    const std::string integrator =
        fmt::format("id = \"linearly_implicit_euler\"\ndt_s = {}\n", dt);
    const auto scene_of = [&](Toy& toy, const std::string& effects) {
      toy.write("head.toml", text({.count = 24,
                                   .model = stiff(model) + "quadrature = 8\n",
                                   .integrator = integrator,
                                   .more = air + effects}));
      return read_scene(path(toy, "head.toml"));
    };
    Toy bare;
    const std::vector<double> without = by_world(scene_of(bare, ""), 0);
    for (const std::string effects :
         {"[effects.body]\nshape = \"ellipsoid\"\nhalf_axes_m = [0.11, 0.1, 0.13]\n"
          "moves = \"head\"\n",
          "[effects.wind]\n", "[effects.strand_interaction]\nouter_radius_m = 0.03\n"}) {
      SCOPED_TRACE(effects);
      Toy toy;
      const Scene scene = scene_of(toy, effects);
      const std::vector<double> want = by_world(scene, 0);
      EXPECT_GT(apart(without, want), 1e-6);
      run(toy, "--frames 64 --threads 2");
      const Hdf5File file(path(toy, "out/head.h5"), Hdf5File::Mode::read);
      EXPECT_LE(apart(all_of(file, HeadFrames::dataset(4)), want),
                apart(by_world(scene, rounding(scene)), want));
    }
  }
}

// The same steps in another order of summation; on a body the head takes the symmetric
// semidefinite part of its derivatives, the world all of them: an error of first order in
// the step, a tenth of what the body does at most. Steps on bodies are compared to
// rounding in tests/models/head/test_spring_head.cpp.
TEST(HeadOfHair, OfSpringsMovesAsTheWorldOfTheSceneDoes) {
  const auto scene_of = [](Toy& toy, const std::string& body) {
    toy.write("head.toml",
              text({.count = 12,
                    .top = "duration_s = 0.05\nframes_per_s = 20\n",
                    .model = "id = \"mass_spring\"\njacobian = \"filtered\"\n",
                    .integrator = "id = \"linearly_implicit_euler\"\ndt_s = 0.001\n",
                    .groom = "[groom.material]\nyoungs_modulus_pa = 3.89e9\n"
                             "density_kg_m3 = 1300\n",
                    .more = "[effects.gravity]\n[effects.linear_drag]\n" + body}));
    return read_scene(path(toy, "head.toml"));
  };
  const auto by_head = [](Toy& toy) {
    run(toy, "--frames 64 --threads 2");
    return all_of(Hdf5File(path(toy, "out/head.h5"), Hdf5File::Mode::read),
                  HeadFrames::dataset(1));
  };
  Toy toy;
  const Scene bare = scene_of(toy, "");
  const std::vector<double> without = by_world(bare, 0);
  EXPECT_LE(apart(by_head(toy), without), 1e-6 * 0.1);
  Toy touched;
  const Scene scene =
      scene_of(touched,
               "[effects.body]\nshape = \"ellipsoid\"\nhalf_axes_m = [0.11, 0.1, 0.13]\n"
               "moves = \"head\"\n");
  const std::vector<double> want = by_world(scene, 0);
  EXPECT_GT(apart(without, want), 1e-4);
  EXPECT_LE(apart(by_head(touched), want), 0.1 * apart(without, want));
}

TEST(HeadOfHair, FramesOnDiskAreThePositionsOfTheHead) {
  Toy toy;
  toy.write("head.toml", text({}));
  const SceneOutline outline = read_outline(path(toy, "head.toml"));
  HeadRun head(make_head(outline, {models::HeadNumber::float64, 4}, 2).head, 2);
  std::vector<double> x;
  head.positions(0, x);
  for (const std::string bits : {"32", "64", "none"}) {
    run(toy, "--frames " + bits);
    const Hdf5File file(path(toy, "out/head.h5"), Hdf5File::Mode::read);
    EXPECT_EQ(file.size("shown/positions"), (std::vector<std::size_t>{5, 21 * 7, 3}));
    std::vector<double> shown(x.size());
    file.read("shown/positions", 0, std::span(shown));
    for (std::size_t i = 0; i < x.size(); ++i) {
      EXPECT_EQ(shown[i], static_cast<double>(static_cast<float>(x[i])));
    }
    if (bits == "none") {
      EXPECT_FALSE(file.has(HeadFrames::dataset(0)));
      continue;
    }
    EXPECT_EQ(all_of(file, HeadFrames::dataset(0)), bits == "64" ? x : shown);
    std::vector<std::int32_t> line(7);
    file.read("connectivity", 20, std::span(line));
    EXPECT_EQ(line.front(), 140);
    EXPECT_EQ(line.back(), 146);
    EXPECT_THAT(toy.read("out/head.xdmf"), HasSubstr("head.h5:/positions/000004<"));
  }
}

TEST(HeadOfHair, TheSeriesHoldsTheEnergiesOfTheWorld) {
  for (const char* model : models_in_all) {
    Toy toy;
    toy.write("head.toml", text({.count = 8, .model = stiff(model)}));
    run(toy, "");
    const CsvTable head = parse_csv(toy.read("out/head.csv"), "csv");
    ASSERT_EQ(head.rows.size(), 5U);
    ASSERT_EQ(toy.run("head.toml --out out --progress none").code, 0);
    const CsvTable world = parse_csv(toy.read("out/head.csv"), "csv");
    for (std::size_t i = 0; i < 5; ++i) {
      for (const std::string column :
           {"t_s", "tip_x_m", "tip_z_m", "kinetic_j", "elastic_j", "gravity_j"}) {
        // The points of an element are those of any strand's need there, here of the four
        // beside it: mass matrices agree to 1e-8 (quadrature_points).
        const double want = world.rows[i].number(column);
        EXPECT_NEAR(head.rows[i].number(column), want, 1e-6 * std::abs(want)) << column;
      }
    }
    EXPECT_GT(head.rows[4].number("kinetic_j"), 0);
    EXPECT_GT(head.rows[4].number("fastest_m_s"), 0);
    EXPECT_EQ(head.rows[4].text("failed_strands"), "0");
  }
}

TEST(HeadOfHair, IsTakenFromAThousandStrandsOnWhereTheSceneCanBeOne) {
  Toy toy;
  toy.write("head.toml", text({.count = 1000, .elements = 1}));
  const std::string automatic = "head.toml --out out --progress none";
  EXPECT_THAT(toy.run(automatic).err, HasSubstr("a batch of 1000 strands of 1 element:"));
  EXPECT_TRUE(toy.exists("out/head.h5"));
  toy.write("head.toml", text({.count = 999, .elements = 1}));
  EXPECT_THAT(toy.run(automatic).err, testing::Not(HasSubstr("a head of")));
  toy.write("head.toml",
            text({.count = 20000, .elements = 1, .more = "[effects.strand_friction]\n"}));
  const Toy::Result many = toy.run(automatic);
  EXPECT_EQ(many.code, 2);
  EXPECT_THAT(many.err, HasSubstr("20000 strands are too many"));
  EXPECT_THAT(many.err, HasSubstr("solves the contacts of all strands together"));
}

TEST(HeadOfHair, ThePageShowsSomeOfTheStrands) {
  Toy toy;
  toy.write("head.toml", text({.count = 1500, .elements = 2}));
  EXPECT_THAT(run(toy, "--vtk --usd").err,
              HasSubstr("; pictures show 1000 of 1500 strands and 5 of 5 frames"));
  const auto page = nlohmann::json::parse(toy.read("out/head.json"));
  EXPECT_EQ(page.at("format"), "tress-strands-1");
  EXPECT_EQ(page.at("times_s").size(), 5U);
  const std::vector<int> ids = page.at("strand_ids");
  ASSERT_EQ(ids.size(), 1000U);
  for (int i = 0; i < 1000; ++i) {
    EXPECT_GE(ids[static_cast<std::size_t>(i)], 3 * i / 2);
    EXPECT_LT(ids[static_cast<std::size_t>(i)], 3 * (i + 1) / 2);
  }
  EXPECT_EQ(page.at("strand_points").size(), 1000U);
  EXPECT_TRUE(toy.exists("out/head_vtk/head.pvd"));
  EXPECT_TRUE(toy.exists("out/head.usda"));
}

/// A thousand frames, long enough to be caught at work.
Hair long_run() {
  return {.count = 400,
          .elements = 10,
          .top = "duration_s = 2\nframes_per_s = 200\ncheckpoint_s = 0.1\n"};
}

void await(const Toy& toy, const std::string& file, const std::string& before = "") {
  const auto there = [&] { return toy.exists(file) && toy.read(file) != before; };
  for (int i = 0; i < 6000 && !there(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  ASSERT_TRUE(there());
}

void expect_same_results(const Toy& a, const Toy& b) {
  EXPECT_EQ(a.read("out/head.csv"), b.read("out/head.csv"));
  EXPECT_EQ(outcome(a).at("state_hash"), outcome(b).at("state_hash"));
  EXPECT_EQ(a.read("out/head.json"), b.read("out/head.json"));
  EXPECT_EQ(a.read("out/head.xdmf"), b.read("out/head.xdmf"));
  const Hdf5File first(path(a, "out/head.h5"), Hdf5File::Mode::read),
      second(path(b, "out/head.h5"), Hdf5File::Mode::read);
  EXPECT_EQ(positions_of(first), positions_of(second));
  for (const std::string dataset : {"series", "shown/positions"}) {
    EXPECT_EQ(first.size(dataset), second.size(dataset));
    EXPECT_EQ(all_of(first, dataset), all_of(second, dataset));
  }
}

TEST(HeadOfHair, KilledItGoesOnAtItsCheckpointWithTheSameBits) {
  Toy through, stopped;
  for (const Toy* toy : {&through, &stopped}) toy->write("head.toml", text(long_run()));
  run(through, "");
  // Killed twice, and by a signal that it may answer, each time with other lanes.
  const std::string resume = std::string(as_head) + "--resume ";
  for (const auto& [signal, options] :
       {std::pair{SIGKILL, ""}, std::pair{SIGKILL, "--simd-width 4 --threads 2"},
        std::pair{SIGTERM, "--simd-width 1"}}) {
    const std::string state =
        stopped.exists("out/head.state") ? stopped.read("out/head.state") : "";
    const pid_t process = stopped.start(resume + options);
    await(stopped, "out/head.state", state);
    kill(process, signal);
    const Toy::Result ended = stopped.wait(process);
    const std::string frames = path(stopped, "out/head.h5");
    if (signal == SIGKILL) {
      // As if it had been at work on what the file says about itself.
      std::fstream file(frames, std::ios::binary | std::ios::in | std::ios::out);
      file.seekp(static_cast<std::streamoff>(std::filesystem::file_size(frames)));
      file << "half";
      file.seekp(0);
      file << std::string(2048, '?');
      continue;
    }
    EXPECT_EQ(ended.code, 130);
    EXPECT_THAT(ended.err, HasSubstr("--resume"));
    // What the run has left can be read.
    const Hdf5File file(frames, Hdf5File::Mode::read);
    const std::size_t count = file.size("series").front();
    EXPECT_GT(count, 20U);
    EXPECT_LT(count, 401U);
    EXPECT_EQ(positions_of(file).size(), count * 400 * 11 * 3);
  }
  run(stopped, "--resume");
  expect_same_results(through, stopped);
  EXPECT_FALSE(stopped.exists("out/head.state"));
  EXPECT_FALSE(stopped.exists("out/head.frames"));
}

// A state is saved by a signal that is answered, and by the clock. Step sizes of strands
// that choose their own are part of it.
TEST(HeadOfHair, AnInterruptedRunWithoutCheckpointsGoesOnWhereItWas) {
  Hair stepped = long_run();
  stepped.top = "duration_s = 1\nframes_per_s = 100\n";
  stepped.integrator = "id = \"linearly_implicit_euler\"\ndt_s = 0.0005\n";
  Hair by_tolerance = controlled("super_helix", 1e-3),
       springs = controlled("mass_spring", 1e-3);
  for (Hair* const hair : {&by_tolerance, &springs}) {
    hair->count = 100;
    hair->top = "duration_s = 0.5\nframes_per_s = 100\n";
  }
  for (const Hair& hair : {stepped, by_tolerance, springs}) {
    Toy through;
    through.write("head.toml", text(hair));
    run(through, "");
    for (const int signal : {SIGTERM, SIGKILL}) {
      // A state of springs has no more than one by tolerance.
      if (hair.model == springs.model && signal == SIGTERM) continue;
      SCOPED_TRACE(hair.model + hair.integrator + std::to_string(signal));
      Toy stopped;
      stopped.write("head.toml", text(hair));
      const std::string begun = signal == SIGTERM ? "out/head.csv" : "out/head.state";
      const pid_t process = stopped.start(std::string(as_head) + "--save-every 0");
      await(stopped, begun);
      await(stopped, begun, stopped.read(begun));
      kill(process, signal);
      EXPECT_EQ(stopped.wait(process).code, signal == SIGTERM ? 130 : 128 + SIGKILL);
      run(stopped, "--resume --simd-width 4");
      expect_same_results(through, stopped);
    }
  }
}

/// Behind what was said of its size, and of a machine that is busy.
void expect_one_error(const Toy::Result& result) {
  const std::size_t error = result.err.find("simulate: error: ");
  ASSERT_NE(error, std::string::npos) << result.err;
  EXPECT_EQ(result.err.find('\n', error), result.err.size() - 1) << result.err;
}

TEST(HeadOfHair, ADamagedStateOrFrameIsRefused) {
  Toy toy;
  toy.write("head.toml", text(long_run()));
  const pid_t process = toy.start(as_head);
  await(toy, "out/head.state");
  kill(process, SIGKILL);
  static_cast<void>(toy.wait(process));
  for (const std::string name : {"out/head.state", "out/head.h5"}) {
    const std::string whole = toy.read(name);
    for (const double place : {0.2, 0.5, 0.9}) {
      std::string bytes = whole;
      char& byte =
          bytes[static_cast<std::size_t>(place * static_cast<double>(bytes.size()))];
      byte = static_cast<char>(byte ^ 1);
      // In .h5, of a chunk between two checkpoints nothing is known: only of the frames
      // before the last one is a change an error.
      if (name == "out/head.h5" && place > 0.4) continue;
      toy.write(name, bytes);
      const Toy::Result result = run(toy, "--resume", 2);
      EXPECT_THAT(result.err, HasSubstr(name));
      expect_one_error(result);
    }
    toy.write(name, whole);
  }
  // Of other numbers, or of another scene.
  EXPECT_THAT(run(toy, "--resume --precision 32", 2).err, HasSubstr("head of 64 bits"));
  EXPECT_THAT(run(toy, "--resume --frames 64", 2).err, HasSubstr("frames of 32"));
  std::filesystem::remove(path(toy, "out/head.h5"));
  expect_one_error(run(toy, "--resume", 2));
}

// A step of 0.05 s under ten thousand times gravity makes nonsense of hair as soft as
// jelly within seconds; hair of a stiffness that nothing bends does not move.
TEST(HeadOfHair, FailedStrandsAreNamedAndTheOthersGoOn) {
  const Hair hair{.count = 8,
                  .top = "duration_s = 3\nframes_per_s = 20\n",
                  .integrator = "id = \"linearly_implicit_euler\"\ndt_s = 0.05\n",
                  .groom = "[groom.material]\nyoungs_modulus_pa = 1e3\n",
                  .root = "motion = \"shake\"\namplitude_m = 0.1\nfrequency_hz = 3\n",
                  .more = "[effects.gravity]\ngravity_m_s2 = [0, 0, -1e5]\n"};
  for (const bool guard : {true, false}) {
    Toy toy;
    toy.write("head.toml", text(hair) +
                               "[[strand]]\nlength_m = 0.1\nelements = 6\n"
                               "[strand.material]\nyoungs_modulus_pa = 1e15\n");
    EXPECT_THAT(run(toy, guard ? "--frames 64" : "--frames 64 --no-guard", 3).err,
                HasSubstr("of 9 strands failed"));
    const CsvTable lost = parse_csv(toy.read("out/head.failed.csv"), "csv");
    const CsvTable series = parse_csv(toy.read("out/head.csv"), "csv");
    ASSERT_EQ(series.rows.size(), 61U);
    EXPECT_GT(lost.rows.size(), 0U);
    EXPECT_EQ(series.rows.back().number("failed_strands"),
              static_cast<double>(lost.rows.size()));
    EXPECT_EQ(outcome(toy).at("failed_strands"), lost.rows.size());
    // In hair that is left there is no more than falling for 3 s gives, with a tenth.
    if (guard) {
      EXPECT_LT(series.rows.back().number("most_kinetic_j"), 1e-4 * 3.3e5 * 3.3e5 / 2);
    }
    const Hdf5File file(path(toy, "out/head.h5"), Hdf5File::Mode::read);
    double before = 0;
    for (const Row& row : lost.rows) {
      EXPECT_NE(row.text("strand"), "0");  // [[strand]] comes before [groom]
      const double t = row.number("t_s");
      EXPECT_GE(t, before);
      before = t;
      EXPECT_THAT(std::string(row.text("reason")),
                  HasSubstr(guard ? "energy" : "finite"));
      // Its shape stays from then on: the tip is as far from the root.
      const auto frame = static_cast<std::size_t>(std::lround(t * 20));
      const auto strand = static_cast<std::size_t>(row.number("strand"));
      const auto reach = [&](std::size_t at) {
        const std::vector<double> x = all_of(file, HeadFrames::dataset(at));
        return norm(load3(&x[21 * strand + 18]) - load3(&x[21 * strand]));
      };
      // Roundings of places of some 0.2 m.
      EXPECT_NEAR(reach(60), reach(frame), 1e-15);
    }
  }
}

// 300 hairs that begin inside of a sphere: steps of 2 ms give them more energy from frame
// to frame, without bound. Strands by themselves end at 0.05 s.
TEST(HeadGuard, FindsHairsThatGainEnergyOnAFixedBody) {
  for (const std::string bits : {"64", "32"}) {
    Toy toy;
    toy.write("head.toml",
              "title = \"head\"\nduration_s = 0.064\nframes_per_s = 200\n[model]\n"
              "id = \"super_helix\"\njacobian = \"elastic\"\n[integrator]\n"
              "id = \"linearly_implicit_euler\"\ndt_s = 0.002\n[groom]\ncount = 300\n"
              "length_m = 0.2\nelements = 5\n[effects.gravity]\n[[effects.body]]\n"
              "shape = \"sphere\"\nradius_m = 0.115\n");
    const std::string said = run(toy, "--precision " + bits, 3).err;
    EXPECT_THAT(said, HasSubstr("m inside body (point "));
    EXPECT_THAT(said, HasSubstr(" of 300 strands), and contact assumes a start outside"));
    EXPECT_THAT(said, HasSubstr("unstable: "));
    EXPECT_THAT(said, HasSubstr("of 300 strands failed, the first at t = 0.0"));
    EXPECT_THAT(said, HasSubstr("try a shorter step than 0.002 s"));
    EXPECT_THAT(toy.read("out/head.failed.csv"), HasSubstr("energy"));
    // m g L = 2e-5 J for each of those that are left.
    const CsvTable series = parse_csv(toy.read("out/head.csv"), "csv");
    EXPECT_LT(series.rows.back().number("most_kinetic_j"), 1e-3);
  }
}

// Sound motions under all loads that the account of energy counts.
TEST(HeadGuard, LeavesSoundMotionsAlone) {
  for (const char* model : models_in_all) {
    for (const char* more :
         {"", "[effects.body]\nshape = \"sphere\"\nradius_m = 0.105\n",
          "[effects.body]\nshape = \"sphere\"\nradius_m = 0.105\nmoves = \"head\"\n",
          "[effects.wind]\nvelocity_m_s = [8, 0, 1]\n",
          "[effects.strand_interaction]\ncoupling = \"lagged\"\n"}) {
      Toy toy;
      const std::string loads = std::string(more).starts_with("[effects.w")
                                    ? "[effects.gravity]\n"
                                    : "[effects.gravity]\n[effects.linear_drag]\n";
      toy.write("head.toml",
                text({.top = "duration_s = 0.02\nframes_per_s = 200\n",
                      .model = stiff(model),
                      .integrator = "id = \"linearly_implicit_euler\"\ndt_s = 0.0001\n",
                      .more = loads + more}));
      EXPECT_EQ(toy.run(std::string(as_head)).code, 0) << model << more;
    }
  }
}

// Of rigid links the points on which bodies act are those of the world.
TEST(HeadGuard, SumsThePotentialsOfEffects) {
  Toy toy;
  toy.write("head.toml",
            text({.top = "duration_s = 0.02\nframes_per_s = 200\n",
                  .model = stiff("articulated_chain"),
                  .integrator = "id = \"linearly_implicit_euler\"\ndt_s = 0.0001\n",
                  .more = "[effects.gravity]\n[effects.body]\nshape = \"sphere\"\n"
                          "radius_m = 0.105\nmoves = \"head\"\n"}));
  ASSERT_EQ(toy.run(as_head).code, 0);
  const CsvTable head = parse_csv(toy.read("out/head.csv"), "csv");
  ASSERT_EQ(toy.run("head.toml --as strands --out out --progress none").code, 0);
  const CsvTable world = parse_csv(toy.read("out/head.csv"), "csv");
  EXPECT_GT(world.rows[0].number("body_j"), 0);
  for (std::size_t i = 0; i < head.rows.size(); ++i) {
    const double want = world.rows[i].number("body_j");
    EXPECT_NEAR(head.rows[i].number("body_j"), want,
                1e-6 * world.rows[0].number("body_j"));
  }
}

// Half of a run, and the rest by a head that recalls what the first knew: the account
// goes on where it was.
TEST(HeadGuard, GoesOnWhereItWas) {
  Toy toy;
  toy.write("head.toml", text({.more = "[effects.gravity]\n[effects.wind]\n"
                                       "velocity_m_s = [8, 0, 1]\n"}));
  const SceneOutline outline = read_outline(path(toy, "head.toml"));
  const auto made = [&] {
    return std::make_unique<HeadRun>(
        make_head(outline, {models::HeadNumber::float64, 4}, 1), 1);
  };
  const auto first = made(), second = made();
  const auto kept = [](HeadRun& run) {
    std::vector<double> all;
    run.by_chunks(run.strands(),
                  [&](HeadRun::Numbers all_of_them) { run.keep(all_of_them, all); });
    return all;
  };
  for (int i = 0; i < 5; ++i) first->step(0.004 * i, 0.004);
  std::vector<double> half = kept(*first);
  EXPECT_EQ(half.size(), first->strands() * first->kept());
  second->by_chunks(second->strands(),
                    [&](HeadRun::Numbers strands) { second->recall(strands, half); });
  EXPECT_EQ(kept(*second), half);
  for (int i = 5; i < 10; ++i) {
    for (HeadRun* run : {first.get(), second.get()}) run->step(0.004 * i, 0.004);
  }
  EXPECT_EQ(kept(*second), kept(*first));
  EXPECT_NE(kept(*first), half);
}

struct Refused {
  std::string name;
  Hair hair;
  std::string options, reason;
};
void PrintTo(const Refused& r, std::ostream* out) { *out << r.name; }  // NOLINT
class HeadRefused : public testing::TestWithParam<Refused> {};

TEST_P(HeadRefused, InOneLine) {
  Toy toy;
  toy.write("head.toml", text(GetParam().hair));
  const Toy::Result result = run(toy, GetParam().options, 2);
  EXPECT_THAT(result.err, HasSubstr(GetParam().reason));
  EXPECT_EQ(result.error_lines(), 1) << result.err;
  EXPECT_EQ(toy.files(), std::vector<std::string>{"head.toml"});
}

/// What has no SIMD lanes runs as replicated systems, and says why; for 32 bits it is
/// refused.
struct Replicated {
  std::string name;
  Hair hair;
  std::string reason, remedy;
};
void PrintTo(const Replicated& r, std::ostream* out) { *out << r.name; }  // NOLINT
class HeadReplicated : public testing::TestWithParam<Replicated> {};

TEST_P(HeadReplicated, WithTheReasonInOneLine) {
  Toy toy;
  Hair hair = GetParam().hair;
  hair.count = 3;
  hair.top = "duration_s = 0.008\nframes_per_s = 250\n";
  toy.write("head.toml", text(hair));
  const std::string said = run(toy, "").err;
  EXPECT_THAT(said, HasSubstr("replicated systems, each as slow as a single strand: no "
                              "SIMD lanes for " +
                              GetParam().reason));
  EXPECT_THAT(said, HasSubstr(GetParam().remedy));
  EXPECT_EQ(outcome(toy).at("engine"), "replicated");
  Toy narrow;
  narrow.write("head.toml", text(hair));
  const Toy::Result refused = run(narrow, "--precision 32", 2);
  EXPECT_THAT(refused.err, HasSubstr("no SIMD lanes for " + GetParam().reason));
  EXPECT_EQ(refused.error_lines(), 1) << refused.err;
}

INSTANTIATE_TEST_SUITE_P(
    Heads, HeadReplicated,
    testing::Values(
        Replicated{"Der",
                   {.model = "id = \"der\"\ntwist = \"quasi_static\"\n"},
                   "twist = \"quasi_static\"",
                   "\"dynamic\""},
        Replicated{"DerByOneCorrection",
                   {.model = "id = \"der\"\n",
                    .integrator = "id = \"linearly_implicit_midpoint\"\ndt_s = 1e-3\n"},
                   "der by linearly_implicit_midpoint",
                   "\"backward_euler\""},
        Replicated{"DerOnceWithFriction",
                   {.model = "id = \"der\"\njacobian = \"elastic\"\n",
                    .more = "[[effects.body]]\nshape = \"sphere\"\nradius_m = "
                            "0.09\nfriction = 0.3\n"},
                   "[effects.body] with friction on der by linearly_implicit_euler",
                   "friction = 0"},
        Replicated{"RodsOfQuaternionsOnce",
                   {.model = "id = \"corde\"\n"},
                   "linearly_implicit_euler with an exact Jacobian",
                   "\"backward_euler\""},
        Replicated{"RodsOfQuaternionsWithATolerance",
                   {.model = "id = \"corde\"\n",
                    .integrator = "id = \"tr_bdf2\"\nposition_tol_rel = 1e-3\n"},
                   "corde with a tolerance",
                   "dt_s instead of position_tol_rel"},
        Replicated{"CosseratByTrBdf2",
                   {.model = "id = \"xpbd_cosserat\"\n",
                    .integrator = "id = \"tr_bdf2\"\ndt_s = 1e-3\n"},
                   "tr_bdf2 on xpbd_cosserat",
                   "backward_euler"},
        Replicated{"SpringsExact",
                   {.model = "id = \"mass_spring\"\n"},
                   "jacobian = \"exact\" with linearly_implicit_euler",
                   "give [model] jacobian = \"filtered\""},
        Replicated{"SpringsThatHoldCurls",
                   {.model = "id = \"mass_spring\"\ntorsion = \"altitude\"\n"},
                   "torsion = \"altitude\"",
                   "torsion = \"none\""},
        Replicated{"ChordSprings",
                   {.model = "id = \"mass_spring\"\nbending = \"second_neighbour\"\n"},
                   "bending = \"second_neighbour\"",
                   "bending = \"angular\""},
        Replicated{"Exact",
                   {.model = "id = \"super_helix\"\n"},
                   "jacobian = \"exact\"",
                   "jacobian = \"elastic\""},
        Replicated{"ChainPlanar",
                   {.model = "id = \"articulated_chain\"\njacobian = \"elastic\"\n"
                             "modes = \"bend_planar\"\n",
                    .groom = "shape = \"wavy\"\n"},
                   "modes = \"bend_planar\"",
                   "modes = \"bend_twist\""},
        Replicated{"ChainSolver",
                   {.model = "id = \"articulated_chain\"\njacobian = \"elastic\"\n"
                             "solver = \"sparse\"\n"},
                   "solver = \"sparse\"",
                   "leave out [model] solver"},
        Replicated{"Points",
                   {.model = "jacobian = \"elastic\"\nquadrature = 24\n"},
                   "24 points of an element",
                   "2 to 16"},
        Replicated{"Method",
                   {.integrator = "id = \"bdf2\"\ndt_s = 0.004\n"},
                   "bdf2",
                   "\"linearly_implicit_midpoint\", \"backward_euler\" or \"tr_bdf2\""},
        Replicated{"IteratedStiff",
                   {.model = "jacobian = \"elastic\"\n",
                    .integrator = "id = \"backward_euler\"\ndt_s = 0.004\n"},
                   "jacobian = \"elastic\" with backward_euler",
                   "jacobian = \"exact\" to backward_euler"},
        Replicated{"ToleranceInSoManySteps",
                   {.model = "id = \"super_helix\"\n",
                    .integrator =
                        "id = \"tr_bdf2\"\nposition_tol_rel = 1e-3\nmax_steps = 1000\n"},
                   "max_steps with a tolerance",
                   "min_step_s instead of max_steps"},
        Replicated{"KeptMatrix",
                   {.model = "id = \"super_helix\"\n",
                    .integrator = "id = \"tr_bdf2\"\ndt_s = 0.004\nrefresh = "
                                  "\"every_step\"\n"},
                   "kept matrices",
                   "leave out [integrator] refresh"},
        Replicated{"WindAtMidpoints",
                   {.model = "id = \"super_helix\"\n",
                    .integrator = "id = \"linearly_implicit_midpoint\"\ndt_s = 0.001\n",
                    .more = "[effects.gravity]\n[effects.wind]\n"},
                   "[effects.wind] with linearly_implicit_midpoint",
                   "linearly_implicit_euler"},
        Replicated{"TwistWithoutInertia",
                   {.model = "id = \"super_helix\"\nrotary_inertia = \"off\"\n",
                    .integrator = "id = \"tr_bdf2\"\ndt_s = 0.004\n"},
                   "tr_bdf2 and twist without inertia",
                   "rotary_inertia = \"on\" or modes = \"bend\""},
        Replicated{"Graded",
                   {.groom = "grading = 1.5\n"},
                   "elements of different lengths",
                   "leave out grading"},
        Replicated{"Free",
                   {.root = "motion = \"free\"\n"},
                   "free roots",
                   "use another [root] motion"},
        Replicated{"Coupled",
                   {.more = "[effects.self_contact]\n"},
                   "[effects.self_contact]",
                   "leave it out"}),
    [](const auto& of) { return of.param.name; });

// Tables with different numbers of elements are a batch each.
TEST(HeadOfHair, RunsEachNumberOfElementsAsABatch) {
  Toy toy;
  toy.write("head.toml", text({.count = 3}) + "[[strand]]\nelements = 7\n");
  EXPECT_THAT(run(toy, "").err, HasSubstr("3 of 6 elements, 1 of 7 elements"));
  EXPECT_TRUE(toy.exists("out/head.6.h5"));
  EXPECT_TRUE(toy.exists("out/head.7.h5"));
}

INSTANTIATE_TEST_SUITE_P(
    Heads, HeadRefused,
    testing::Values(
        Refused{"SpringsIn32Bits",
                {.model = "id = \"mass_spring\"\njacobian = \"filtered\"\n"},
                "--precision 32",
                "springs in single precision"},
        Refused{"NarrowMidpointsOfChains",
                {.model = "id = \"articulated_chain\"\n",
                 .integrator = "id = \"linearly_implicit_midpoint\"\n"},
                "--precision 32",
                "give --precision 64"},
        Refused{"NarrowTolerance",
                {.model = "id = \"super_helix\"\n",
                 .integrator = "id = \"tr_bdf2\"\nposition_tol_rel = 1e-3\n"},
                "--precision 32",
                "give --precision 64, or a larger tolerance"},
        Refused{"Mesh",
                {.more = "[effects.gravity]\n[effects.control_mesh]\n"},
                "",
                "ties all strands into one mesh (head.toml:"},
        Refused{"Rubbing",
                {.more = "[effects.strand_friction]\n"},
                "",
                "solves the contacts of all strands together (head.toml:"},
        Refused{"Monolithic",
                {.more = "[effects.strand_interaction]\ncoupling = \"monolithic\"\n"},
                "",
                "coupling = \"lagged\""},
        Refused{"TouchingWithTolerance",
                {.model = "id = \"super_helix\"\n",
                 .integrator = "id = \"tr_bdf2\"\nposition_tol_rel = 1e-3\n",
                 .more = "[effects.strand_interaction]\ncoupling = \"lagged\"\n"},
                "",
                "share their intervals"},
        Refused{"Hairs", {}, "--hairs 10", "--hairs cannot be combined with --as batch"},
        Refused{"ErrorBars",
                {},
                "--error-bars",
                "--error-bars cannot be combined with --as batch"},
        Refused{"Lanes", {}, "--simd-width 16", "16 lanes"},
        Refused{"NarrowLanes", {}, "--precision 32 --simd-width 4", "4 lanes"},
        Refused{"Bits", {}, "--precision 16", "--precision"},
        Refused{"Frames", {}, "--frames 16", "--frames"},
        Refused{"As", {}, "--as one", "--as"},
        Refused{"Many", {.count = 1000001}, "", "count"},
        Refused{"ManyElements", {.count = 1000000, .elements = 50}, "", "strands"}),
    [](const auto& of) { return of.param.name; });

// Nothing runs in more bits than were asked for without a word.
TEST(HeadOfHair, StrandsOneByOneAreRefusedIn32Bits) {
  Toy toy;
  toy.write("head.toml", text({.count = 3}));
  const Toy::Result few = toy.run("head.toml --precision 32 --out out");
  EXPECT_EQ(few.code, 2);
  EXPECT_THAT(few.err, HasSubstr("give --as batch"));
  toy.write("head.toml",
            text({.count = 1000,
                  .model = "id = \"super_helix\"\n",
                  .integrator = "id = \"tr_bdf2\"\nposition_tol_rel = 1e-3\n"}));
  const Toy::Result unresolved = toy.run("head.toml --precision 32 --out out");
  EXPECT_EQ(unresolved.code, 2);
  EXPECT_THAT(unresolved.err, HasSubstr("position_tol_rel = 0.001 in 32 bits"));
  EXPECT_EQ(toy.files(), std::vector<std::string>{"head.toml"});
}

TEST(HeadOfHair, MoreThanTheMemoryIsRefusedBeforeItIsBuilt) {
  Toy toy;
  toy.write("head.toml", text({.count = 1000000, .elements = 20}));
  const Toy::Result result = toy.run(as_head, "ulimit -v 1000000;");
  EXPECT_EQ(result.code, 2);
  EXPECT_THAT(result.err, HasSubstr("1000000 strands of 20 elements needs about"));
  EXPECT_THAT(result.err, HasSubstr("--precision 32"));
}

TEST(SceneOutline, MakesTheStrandsOfTheScene) {
  Toy toy;
  toy.write("head.toml", text({.groom = "shape = \"fuzzy\"\n"}) +
                             "[[strand]]\nelements = 5\n[[strand]]\nelements = 4\n");
  const Scene scene = read_scene(path(toy, "head.toml"));
  const SceneOutline outline = read_outline(path(toy, "head.toml"));
  ASSERT_EQ(outline.series->size(), scene.strands.size());
  EXPECT_EQ(outline.scene.strands.size(), 3U);
  EXPECT_EQ(outline.series->elements(), 9U + 21U * 6U);
  for (std::size_t k = 0; k < scene.strands.size(); ++k) {
    const Strand made = outline.series->strand(k);
    const Strand& want = scene.strands[k];
    ASSERT_EQ(made.segments.size(), want.segments.size()) << k;
    EXPECT_EQ(norm(made.root.position - want.root.position), 0);
    for (std::size_t i = 0; i < made.segments.size(); ++i) {
      EXPECT_EQ(norm(made.segments[i].natural - want.segments[i].natural), 0);
    }
  }
}

TEST(Hdf5, KeepsNumbersAndGrows) {
  Toy toy;
  const std::string name = path(toy, "x.h5");
  const std::vector<double> first{1, 2, 3, 4, 5, 6}, second{7, 8, 9, 10, 11, 1e-300};
  {
    Hdf5File file(name, Hdf5File::Mode::create);
    file.set("number", 0.1);
    file.create("a/x", {Hdf5Type::float64, {1, 2, 3}, {1, 2, 3}});
    file.write("a/x", 0, std::span(first));
    file.resize("a/x", 2);
    file.write("a/x", 1, std::span(second));
    EXPECT_THROW(file.write("a/x", 2, std::span(second)), InputError);
    EXPECT_THROW(file.write("a/y", 0, std::span(second)), InputError);
  }
  const Hdf5File file(name, Hdf5File::Mode::read);
  EXPECT_EQ(file.number("number"), 0.1);
  EXPECT_EQ(file.size("a/x"), (std::vector<std::size_t>{2, 2, 3}));
  std::vector<double> x(6);
  file.read("a/x", 1, std::span(x));
  EXPECT_EQ(x, second);
  EXPECT_FALSE(file.has("b"));
  try {
    const Hdf5File none(path(toy, "none.h5"), Hdf5File::Mode::read);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("none.h5"));
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
  }
}

}  // namespace tress::test_head
