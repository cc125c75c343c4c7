// The program `simulate` as its users run it: what it writes, that a run can be stopped
// at any moment and continued, and what it says about bad input.
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <numeric>
#include <thread>

#include "experiments/simulate/head_pictures.h"
#include "simulation/files/csv.h"
#include "simulation/files/files.h"
#include "simulation/scene/scene.h"
#include "tests/harness/toy_process.h"

namespace tress::test_simulate {

using namespace simulation;

/// One hair that falls, with frames until 1 s.
std::string falling(const std::string& model, const std::string& more = "") {
  return "title = \"falls\"\nduration_s = 1\nframes_per_s = 50\ncheckpoint_s = 0.1\n"
         "[model]\nid = \"" +
         model +
         "\"\n[integrator]\nid = \"linearly_implicit_euler\"\ndt_s = 0.001\n"
         "[material]\nname = \"hair.caucasian\"\n"
         "[strand]\nlength_m = 0.1\nelements = 10\n[root]\nmotion = \"shake\"\n"
         "amplitude_m = 0.02\nfrequency_hz = 2\n[effects.gravity]\n" +
         more;
}

/// Strands that touch while they are shaken; long enough to be caught at work.
std::string groom(int frames = 100) {
  return "title = \"groom\"\nduration_s = " + std::to_string(frames / 100.0) +
         "\nframes_per_s = 100\ncheckpoint_s = 0.05\nseed = 7\n"
         "[model]\nid = \"der\"\n[integrator]\nid = \"linearly_implicit_euler\"\n"
         "dt_s = 0.001\n[material]\nname = \"hair.asian\"\n"
         "[groom]\ncount = 20\nlength_m = 0.08\nelements = 12\n"
         "[root]\nmotion = \"rotate\"\nangle_rad = 0.5\nfrequency_hz = 2\n"
         "[effects.gravity]\n[effects.linear_drag]\n[effects.strand_interaction]\n";
}

bool wait_for(const Toy& toy, const std::string& file) {
  for (int i = 0; i < 3000 && !toy.exists(file); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return toy.exists(file);
}

// 0.05 s are a frame and a half, 0.01 s less than one.
TEST(Simulate, RunsTheWholeDurationWhereItIsNoWholeNumberOfFrames) {
  for (const auto& [duration, frames] : {std::pair{"0.05", 3U}, std::pair{"0.01", 2U}}) {
    Toy toy;
    toy.write("fall.toml",
              std::string("title = \"t\"\nduration_s = ") + duration +
                  "\nframes_per_s = 30\n[integrator]\ndt_s = 0.0016666666666666667\n"
                  "[strand]\nelements = 1\n[effects.gravity]\n");
    const Toy::Result run = toy.run("fall.toml --out out --progress none");
    ASSERT_EQ(run.code, 0) << run.err;
    const CsvTable table = parse_csv(toy.read("out/fall.csv"), "fall.csv");
    ASSERT_EQ(table.rows.size(), frames);
    EXPECT_EQ(table.rows.back().number("t_s"), std::stod(duration));
    // Steps divide this frame too; times are sums of frames, good to some units of them.
    EXPECT_NEAR(table.rows.back().number("dt_s"), 1.0 / 600, 1e-15);
  }
}

TEST(Simulate, WritesASeriesThatConservesEnergy) {
  Toy toy;
  toy.write("fall.toml",
            "title = \"falls\"\nduration_s = 0.2\nframes_per_s = 50\n[model]\n"
            "id = \"super_helix\"\n[integrator]\nid = \"implicit_midpoint\"\n"
            "dt_s = 0.0005\n[material]\nname = \"hair.asian\"\n"
            "internal_friction_kg_m3_s = 0\n[strand]\nlength_m = 0.1\nelements = 8\n"
            "[root]\nmotion = \"fixed\"\n[effects.gravity]\n");
  const Toy::Result run = toy.run("fall.toml --out out --progress none");
  ASSERT_EQ(run.code, 0) << run.err;
  const CsvTable table = parse_csv(toy.read("out/fall.csv"), "fall.csv");
  ASSERT_EQ(table.rows.size(), 11U);
  // Released at rest: what gravity gives goes into motion and bending. Implicit midpoint
  // errs by O(h^2) of the fastest motion that has energy; a percent of what has fallen.
  const Row& first = table.rows.front();
  const auto total = [](const Row& row) {
    return row.number("kinetic_j") + row.number("elastic_j") + row.number("gravity_j");
  };
  EXPECT_EQ(first.number("kinetic_j"), 0);
  for (const Row& row : table.rows) {
    const double fallen = first.number("gravity_j") - row.number("gravity_j");
    EXPECT_NEAR(total(row), total(first), 0.01 * fallen + 1e-18);
    EXPECT_EQ(row.number("stretch_rel"), 0);
  }
  EXPECT_LT(table.rows.back().number("tip_z_m"), -0.05);
  EXPECT_NEAR(table.rows.back().number("dt_s"), 0.0005, 1e-12);
}

TEST(Simulate, ThePageHasEveryFrameInItsBox) {
  Toy toy;
  toy.write("fall.toml", falling("super_helix"));
  ASSERT_EQ(toy.run("fall.toml --out out --progress none --vtk --usd").code, 0);
  const auto page = nlohmann::json::parse(toy.read("out/fall.json"));
  EXPECT_EQ(page["format"], "tress-strands-1");
  EXPECT_EQ(page["times_s"].size(), 51U);
  // At least the ends of 10 elements. 51 frames of points of 3 numbers of 2 bytes, 4
  // characters for 3 bytes.
  const std::size_t points = page["strand_points"][0];
  EXPECT_GE(points, 11U);
  EXPECT_EQ(page["positions"].get<std::string>().size(), (51 * points * 6 + 2) / 3 * 4);
  EXPECT_EQ(page["channels"][0]["values"].get<std::string>().size(),
            (51 * points + 2) / 3 * 4);
  EXPECT_LT(page["low"][2], -0.05);

  const std::string vtp = toy.read("out/fall_vtk/fall_00050.vtp");
  const std::string sizes =
      "NumberOfPoints=\"" + std::to_string(points) + "\" NumberOfLines=\"1\"";
  EXPECT_NE(vtp.find(sizes), std::string::npos);
  // The last array is the ends of the lines: its size, then one number.
  const std::size_t end = vtp.find("\n</AppendedData>");
  ASSERT_NE(end, std::string::npos);
  std::int32_t offset = 0;
  vtp.copy(reinterpret_cast<char*>(&offset), 4, end - 4);
  EXPECT_EQ(static_cast<std::size_t>(offset), points);
  EXPECT_NE(toy.read("out/fall_vtk/fall.pvd").find("fall_00050.vtp"), std::string::npos);
  EXPECT_NE(toy.read("out/fall.usda").find("BasisCurves"), std::string::npos);
}

/// Of the last frame, by the text of a scene: the sum of all contact forces, N.
Vec contact_forces(Toy& toy, const std::string& text) {
  toy.write("touching.toml", text);
  const Toy::Result run = toy.run("touching.toml --out out --progress none");
  EXPECT_EQ(run.code, 0) << run.err;
  const auto page = nlohmann::json::parse(toy.read("out/touching.json"));
  Vec sum;
  const auto& last = page["contacts"].back();
  EXPECT_GE(last.size(), 12U);
  for (std::size_t i = 0; i < last.size(); i += 6) {
    sum = sum + Vec{last[i + 3], last[i + 4], last[i + 5]};
  }
  return sum;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

// Of a hair that rests on a slope: they bear its weight, whichever law finds them. They
// are written with four digits.
TEST(Simulate, ThePageHasTheContactForces) {
  const std::string at_rest = read_file(TRESS_SOURCE_DIR "/scenes/strand_on_slope.toml");
  const double mass = parse_scene(at_rest, "strand_on_slope.toml").strands.front().mass();
  const double weight = mass * 9.81, digits = 1e-3 * weight;
  for (const std::string model : {"super_helix", "der", "corde"}) {
    const std::string scene = replaced(at_rest, "super_helix", model);
    for (const std::string& law :
         {scene, scene + "\n[effects.strand_friction]\nfriction = 0.3\n"}) {
      Toy toy;
      const Vec sum = contact_forces(toy, law);
      EXPECT_NEAR(sum.x, 0, digits) << model;
      EXPECT_NEAR(sum.y, 0, digits) << model;
      EXPECT_NEAR(sum.z, weight, digits) << model;
    }
  }
}

// Hair on hair: what one does to the other, the other does to it.
TEST(Simulate, ThePageHasForcesBetweenStrandsInPairs) {
  Toy toy;
  const Vec sum =
      contact_forces(toy, read_file(TRESS_SOURCE_DIR "/scenes/hair_on_hair.toml"));
  constexpr double digits = 1e-8;  // of forces of microneutons
  EXPECT_LT(norm(sum), digits);
}

/// As groom(), each strand by steps of its own and exchanges under control.
std::string controlled_groom() {
  std::string scene = groom();
  const std::string given = "id = \"linearly_implicit_euler\"\ndt_s = 0.001";
  return scene.replace(scene.find(given), given.size(),
                       "id = \"tr_bdf2\"\nposition_tol_rel = 1e-2");
}

std::string continued(const std::string& which) {
  if (which == "groom") return groom();
  if (which == "meshed_groom") {
    return groom() + "[effects.control_mesh]\nwidth_m = 0.2\nbreak_m = 1e-3\n";
  }
  return which == "controlled_groom" ? controlled_groom() : falling(which);
}

class Continued : public testing::TestWithParam<std::string> {};

/// A run through and one that was ended by a signal, then continued, write the same
/// bytes.
TEST_P(Continued, AStoppedRunEndsBitByBitLikeOneThatGoesThrough) {
  for (const int signal : {SIGKILL, SIGINT}) {
    Toy through, stopped;
    for (const Toy* toy : {&through, &stopped}) {
      toy->write("scene.toml", continued(GetParam()));
    }
    ASSERT_EQ(through.run("scene.toml --out out --progress none").code, 0);
    const pid_t process = stopped.start("scene.toml --out out --progress none");
    ASSERT_TRUE(wait_for(stopped, "out/scene.csv"));
    if (GetParam().ends_with("groom")) {
      ASSERT_TRUE(wait_for(stopped, "out/scene.state"));
    }
    kill(process, signal);
    static_cast<void>(stopped.wait(process));
    // What is there is a table with whole lines.
    const std::string so_far = stopped.read("out/scene.csv");
    EXPECT_NO_THROW(
        static_cast<void>(parse_csv(so_far.substr(0, so_far.rfind('\n') + 1), "csv")));
    ASSERT_EQ(stopped.run("scene.toml --out out --progress none --resume").code, 0);
    EXPECT_EQ(stopped.read("out/scene.csv"), through.read("out/scene.csv"));
    EXPECT_EQ(stopped.read("out/scene.json"), through.read("out/scene.json"));
    EXPECT_FALSE(stopped.exists("out/scene.state"));
  }
}

INSTANTIATE_TEST_SUITE_P(Models, Continued,
                         testing::Values("super_helix", "der", "corde", "groom",
                                         "controlled_groom", "meshed_groom"),
                         [](const auto& tested) { return tested.param; });

/// Least distance of two of these strands' roots on Fibonacci's lattice of `all`, in the
/// unit square of heights and angles, by the side of a square for each.
double closest(const std::vector<std::size_t>& strands, std::size_t all) {
  double least = 1;
  for (std::size_t i = 0; i < strands.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double turns =
          static_cast<double>(strands[i] - strands[j]) * (std::numbers::phi - 1);
      least = std::min(least, std::hypot(turns - std::round(turns),
                                         static_cast<double>(strands[i] - strands[j]) /
                                             static_cast<double>(all)));
    }
  }
  return least * std::sqrt(static_cast<double>(strands.size()));
}

// Roots lie evenly, not in strips: as far apart as those of a head of 1000, but for the
// angles among k strands in turn. From the n-th of Fibonacci's numbers on, k of these
// leave gaps of phi^(2 - n) turns at most; both of two strands are half of one off.
TEST(Pictures, ShowStrandsOfAHeadEvenly) {
  std::vector<std::size_t> all(1000);
  std::iota(all.begin(), all.end(), std::size_t{0});
  const double lattice = closest(all, 1000);
  for (const auto& [k, n] : {std::pair{100U, 11}, {150U, 12}, {200U, 12}, {1000U, 16}}) {
    const double gap = std::pow(std::numbers::phi, 2 - n) * std::sqrt(1000);
    EXPECT_GT(closest(experiments::scene_runs::shown_strands(1000 * k), 1000 * k),
              lattice - gap)
        << k;
  }
}

TEST(Simulate, RunsByToleranceAndVerifiesIt) {
  std::string scene = falling("super_helix");
  const std::string given = "id = \"linearly_implicit_euler\"\ndt_s = 0.001";
  scene.replace(scene.find(given), given.size(),
                "id = \"tr_bdf2\"\nposition_tol_rel = 1e-3");
  Toy toy;
  toy.write("fall.toml", scene);
  const Toy::Result run = toy.run("fall.toml --out out --progress none --verify");
  ASSERT_EQ(run.code, 0) << run.err;
  for (const char* const words :
       {" steps, ", "rejected by their error", "the shortest "}) {
    EXPECT_NE(run.err.find(words), std::string::npos) << run.err;
  }
  const std::string before = "fall: time error ";
  const auto at = run.err.find(before);
  ASSERT_NE(at, std::string::npos) << run.err;
  const double achieved = std::stod(run.err.substr(at + before.size()));
  EXPECT_GT(achieved, 0);
  // Steps are controlled, their sum over an undamped second is of that size.
  EXPECT_LE(achieved, 1e-2);
}

TEST(Simulate, ElementsOfAStrandWithAToleranceAreTried) {
  Toy toy;
  std::string scene = falling("super_helix");
  const std::string before = "elements = 10";
  scene.replace(scene.find(before), before.size(), "elements = 40\ntolerance_m = 0.001");
  toy.write("fall.toml", scene);
  const Toy::Result run = toy.run("fall.toml --out out --progress none");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.err.find("fall: pilot: "), std::string::npos) << run.err;
  const auto outcome = nlohmann::json::parse(toy.read("out/fall.meta.json"))["outcome"];
  EXPECT_GE(outcome["pilot_elements"], outcome["pilot_elements_at_rest"]);
  EXPECT_GE(outcome["pilot_tries"], 1);
  EXPECT_LE(outcome["pilot_error_rel"], 1);
}

TEST(Simulate, ErrorsAndCountsStandInTheManifestAndBesideTheSeries) {
  Toy toy;
  toy.write("fall.toml", falling("super_helix"));
  const Toy::Result run = toy.run("fall.toml --out out --progress none --error-bars");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.err.find("fall: time error "), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("fall: space error "), std::string::npos) << run.err;
  const auto meta = nlohmann::json::parse(toy.read("out/fall.meta.json"));
  const auto& outcome = meta["outcome"];
  EXPECT_EQ(outcome["steps"], 1000);
  EXPECT_EQ(outcome["solves"], 1000);
  const CsvTable table = parse_csv(toy.read("out/fall.errors.csv"), "fall.errors.csv");
  ASSERT_EQ(table.rows.size(), 51U);
  for (const std::string part : {"time", "space"}) {
    double largest = 0;
    for (const Row& row : table.rows) {
      const double error = row.number(part + "_error_max_rel");
      if (!std::isnan(error)) largest = std::max(largest, error);
    }
    EXPECT_EQ(outcome[part + "_error_max_rel"], largest);
    EXPECT_GT(largest, 0);
  }
  // A later run without them leaves no errors of an older one.
  ASSERT_EQ(toy.run("fall.toml --out out --progress none").code, 0);
  EXPECT_FALSE(toy.exists("out/fall.errors.csv"));
}

TEST(Simulate, TellsOfExchangesThatErrorControlChose) {
  Toy toy;
  toy.write("scene.toml", controlled_groom());
  const Toy::Result run = toy.run("scene.toml --out out --progress none");
  ASSERT_EQ(run.code, 0) << run.err;
  const auto at = run.err.find(" exchanges between strands, ");
  ASSERT_NE(at, std::string::npos) << run.err;
  // 100 frames, each the end of an interval, by saved states too.
  const auto number = run.err.rfind(' ', at - 1) + 1;
  EXPECT_GE(std::stol(run.err.substr(number)), 100);
  EXPECT_NE(run.err.find("the shortest ", at), std::string::npos) << run.err;
}

TEST(Simulate, ThreadsDoNotChangeABit) {
  Toy one, two;
  for (const Toy* toy : {&one, &two}) toy->write("scene.toml", groom(20));
  ASSERT_EQ(one.run("scene.toml --out out --progress none --threads 1").code, 0);
  ASSERT_EQ(two.run("scene.toml --out out --progress none --threads 2").code, 0);
  EXPECT_EQ(one.read("out/scene.csv"), two.read("out/scene.csv"));
  EXPECT_EQ(one.read("out/scene.json"), two.read("out/scene.json"));
}

TEST(Simulate, AnotherSceneIsNotContinued) {
  Toy toy;
  toy.write("scene.toml", groom());
  const pid_t process = toy.start("scene.toml --out out --progress none");
  ASSERT_TRUE(wait_for(toy, "out/scene.state"));
  kill(process, SIGINT);
  ASSERT_EQ(toy.wait(process).code, 130);
  toy.write("scene.toml", groom(20));
  const Toy::Result run = toy.run("scene.toml --out out --progress none --resume");
  EXPECT_EQ(run.code, 2);
  EXPECT_NE(run.err.find("other scene"), std::string::npos) << run.err;
}

TEST(Simulate, ASceneThatBlowsUpIsSaidSo) {
  Toy toy;
  std::string scene = falling("super_helix");
  // Explicit, far beyond the limit of its fastest wave.
  scene.replace(scene.find("linearly_implicit_euler"), 23, "symplectic_euler");
  toy.write("scene.toml", scene);
  const Toy::Result run = toy.run("scene.toml --out out --progress none");
  EXPECT_EQ(run.code, 3);
  EXPECT_NE(run.err.find("strand 0"), std::string::npos) << run.err;
  EXPECT_GE(parse_csv(toy.read("out/scene.csv"), "csv").rows.size(), 1U);
  EXPECT_NE(toy.read("out/scene.meta.json").find("diverged"), std::string::npos);
}

/// On index 3, ida finds no first step at a small rtol. The last frame is that of t = 0.
TEST(Simulate, TellsTheTimeThatAFailedRunReached) {
  Toy toy;
  toy.write("scene.toml",
            "title = \"t\"\nduration_s = 0.2\nframes_per_s = 10\n[model]\n"
            "id = \"inextensible_strand\"\n[integrator]\nid = \"ida\"\n"
            "formulation = \"index3\"\nrtol = 1e-8\n[strand]\nlength_m = 0.1\n"
            "elements = 3\n[root]\n[effects.gravity]\n[[supports]]\nat = \"tip\"\n"
            "kind = \"ball\"\nstiffness_n_per_m = 1e-3\n");
  const Toy::Result run = toy.run("scene.toml --out out --progress none");
  EXPECT_EQ(run.code, 3);
  EXPECT_NE(run.err.find("1 frame, 0 s simulated"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("on their strands at 0 s: "), std::string::npos) << run.err;
  const auto meta = nlohmann::json::parse(toy.read("out/scene.meta.json"));
  EXPECT_NE(meta.dump().find("\"simulated_s\":0"), std::string::npos) << meta;
}

struct Wrong {
  std::string name, arguments, message;
};

class SimulateBadInput : public testing::TestWithParam<Wrong> {};

TEST_P(SimulateBadInput, IsOneLineExitCode2AndNothingWritten) {
  Toy toy;
  toy.write("good.toml", falling("super_helix"));
  toy.write("typo.toml", falling("super_helix", "[effects.linear_drga]\n"));
  toy.write("old_key.toml", falling("super_helix") + "acceleration_m_s2 = [0, 0, -1]\n");
  toy.write("key.toml", falling("super_helix") + "gravty_m_s2 = [0, 0, -1]\n");
  toy.write("nan.toml",
            falling("super_helix", "[effects.linear_drag]\ndrag_kg_m_s = nan\n"));
  toy.write("sweeps.toml",
            "title = \"t\"\nduration_s = 0.1\n[model]\nid = \"xpbd_cosserat\"\n"
            "[integrator]\nid = \"stable_cosserat_rods\"\ndt_s = 0.0005\n[strand]\n"
            "elements = 10\n[effects.gravity]\n");
  toy.write("gap.toml",
            "title = \"t\"\nduration_s = 0.1\n[[strand]]\nlength_m = 0.1\n"
            "root_tangent = [0, 0, -1]\n[[strand]]\nlength_m = 0.1\nroot = \"free\"\n"
            "position_m = [0, 0.01, -0.1]\nroot_tangent = [0, 0, -1]\n[[joints]]\n"
            "a = [0, \"tip\"]\nb = [1, \"root\"]\nkind = \"ball\"\n[effects.gravity]\n");
  const auto before = toy.files();
  const Toy::Result run = toy.run(GetParam().arguments);
  EXPECT_EQ(run.code, 2);
  EXPECT_EQ(run.error_lines(), 1) << run.err;
  EXPECT_NE(run.err.find(GetParam().message), std::string::npos) << run.err;
  EXPECT_EQ(toy.files(), before);
}

INSTANTIATE_TEST_SUITE_P(
    All, SimulateBadInput,
    testing::Values(
        Wrong{"missing", "nowhere.toml --out out", "nowhere.toml"},
        Wrong{"folder", ". --out out", "directory"},
        Wrong{"effect", "typo.toml --out out", "linear_drag"},
        Wrong{"key", "key.toml --out out", "did you mean 'gravity_m_s2'"},
        Wrong{"old_key", "old_key.toml --out out", "it is called 'gravity_m_s2' now"},
        Wrong{"nan", "nan.toml --out out", "nan.toml:"},
        Wrong{"option", "good.toml --treads 2", "did you mean '--threads'"},
        Wrong{"threads", "good.toml --threads 0", "threads"},
        Wrong{"no_scenes", "--out out", "scene"},
        Wrong{"second_is_bad", "good.toml typo.toml --out out", "linear_drag"},
        Wrong{"verify", "good.toml --verify --out out", "position_tol_rel"},
        Wrong{"error_bars_of_sweeps", "sweeps.toml --error-bars --out out",
              "stable_cosserat_rods ends a step after a number of sweeps"},
        Wrong{"one_name", "good.toml ./good.toml --out out", "one name"},
        Wrong{"joint_with_a_gap", "gap.toml --check --out out",
              "the points of a joint begin 0.01 m apart"},
        Wrong{"output_is_a_file", "good.toml --out good.toml", "folder"}),
    [](const auto& tested) { return tested.param.name; });

}  // namespace tress::test_simulate
