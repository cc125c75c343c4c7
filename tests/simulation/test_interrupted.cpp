// The program `simulate` stopped at any moment, and what it continues from: a state that
// is as it was written, of this very scene, by this very program.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <iterator>
#include <nlohmann/json.hpp>
#include <thread>

#include "contract/input_error.h"
#include "experiments/run/exit_code.h"
#include "experiments/run/interruption.h"
#include "simulation/files/checksum.h"
#include "simulation/files/csv.h"
#include "simulation/files/file_state.h"
#include "simulation/files/files.h"
#include "simulation/files/run_key.h"
#include "tests/harness/toy_process.h"

namespace tress::test_interrupted {

using namespace experiments;

using testing::HasSubstr;

std::string swinging(const std::string& elements, const std::string& times) {
  return "title = \"swings\"\n" + times +
         "[material]\nname = \"hair.caucasian\"\n[strand]\nlength_m = 0.1\nelements = " +
         elements + "\n[root]\nmotion = \"fixed\"\n[effects.gravity]\n";
}

/// One frame after the first, of 8 million steps of 200 elements: a quarter of an hour.
std::string endless() {
  return swinging("200",
                  "duration_s = 50\nframes_per_s = 0.02\n[integrator]\n"
                  "id = \"linearly_implicit_euler\"\ndt_s = 6e-6\n");
}

constexpr const char* run = "scene.toml --out out --progress none";

/// Until the time series has so many lines, the first of which is its header.
void await_lines(const Toy& toy, std::size_t count) {
  const auto lines = [&] {
    const std::string text = toy.exists("out/scene.csv") ? toy.read("out/scene.csv") : "";
    return static_cast<std::size_t>(std::ranges::count(text, '\n'));
  };
  for (int i = 0; i < 3000 && lines() < count; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

TEST(Interrupted, InsideAFrameThatWouldTakeAQuarterOfAnHour) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    Toy toy;
    toy.write("scene.toml", endless());
    const pid_t process = toy.start(run);
    await_lines(toy, 2);
    kill(process, signal);
    const Toy::Result ended = toy.wait(process);
    EXPECT_EQ(ended.code, 130);
    EXPECT_THAT(ended.err, HasSubstr("--resume"));
    EXPECT_THAT(toy.files(),
                testing::ElementsAre("out", "out/scene.csv", "out/scene.frames",
                                     "out/scene.state", "scene.toml"));
  }
}

TEST(Interrupted, IsContinuedFromTheLastFrameWithoutCheckpoints) {
  const std::string scene = swinging("10",
                                     "duration_s = 1\nframes_per_s = 50\n[integrator]\n"
                                     "id = \"linearly_implicit_euler\"\ndt_s = 1e-4\n");
  Toy through;
  through.write("scene.toml", scene);
  ASSERT_EQ(through.run(run).code, 0);
  // One signal is answered; of what the other leaves, the clock has saved the state.
  for (const int signal : {SIGTERM, SIGKILL}) {
    Toy stopped;
    stopped.write("scene.toml", scene);
    const pid_t process = stopped.start(std::string(run) + " --save-every 0");
    await_lines(stopped, 4);
    kill(process, signal);
    ASSERT_EQ(stopped.wait(process).code, signal == SIGTERM ? 130 : 128 + SIGKILL);
    const std::string so_far = stopped.read("out/scene.csv");
    EXPECT_LT(parse_csv(so_far.substr(0, so_far.rfind('\n') + 1), "csv").rows.size(),
              51U);
    // The frames that are there are not computed again: without them it cannot go on.
    const std::string frames = stopped.read("out/scene.frames");
    stopped.write("out/scene.frames", "");
    EXPECT_EQ(stopped.run(std::string(run) + " --resume").code, 2);
    stopped.write("out/scene.frames", frames);
    ASSERT_EQ(stopped.run(std::string(run) + " --resume").code, 0);
    const auto all = parse_csv(through.read("out/scene.csv"), "csv");
    const auto both = parse_csv(stopped.read("out/scene.csv"), "csv");
    ASSERT_EQ(both.rows.size(), all.rows.size());
    // Newton's iteration begins anew with another guess: 10 000 steps, each right to
    // 1e-10 of the unknowns, on a hair of 0.1 m whose swing forgets none of them.
    for (std::size_t i = 0; i < all.rows.size(); ++i) {
      EXPECT_EQ(both.rows[i].text("t_s"), all.rows[i].text("t_s"));
      for (const std::string column : {"tip_x_m", "tip_z_m"}) {
        EXPECT_NEAR(both.rows[i].number(column), all.rows[i].number(column), 1e-7);
      }
    }
    EXPECT_TRUE(stopped.exists("out/scene.json"));
    EXPECT_FALSE(stopped.exists("out/scene.state"));
    EXPECT_FALSE(stopped.exists("out/scene.frames"));
  }
}

TEST(Interrupted, OptionsThatCannotBeMeantAreRefused) {
  Toy toy;
  toy.write("scene.toml", swinging("3", ""));
  for (const auto& [option, said] :
       {std::pair{" --save-every nan", "nan is not a number"},
        std::pair{" --frames 64", "--frames is for the .h5 of a batch"}}) {
    const Toy::Result refused = toy.run(std::string(run) + option);
    EXPECT_EQ(refused.code, 2);
    EXPECT_THAT(refused.err, HasSubstr(said));
  }
}

TEST(Interrupted, ASecondSignalEndsAtOnce) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(static_cast<void>(exit_code("test",
                                          [] {
                                            Interruption interruption("test");
                                            // Saving hangs, say on a disk that is gone.
                                            const Interruption::Save save(
                                                interruption, [] {
                                                  kill(getpid(), SIGTERM);
                                                  while (true) pause();
                                                });
                                            kill(getpid(), SIGINT);
                                            while (true) pause();
                                            return 0;
                                          })),
              testing::ExitedWithCode(130), "");
}

/// What a run says that is to continue one whose file `name` was changed.
std::string message_after(const std::string& name,
                          const std::function<std::string(std::string)>& change) {
  Toy toy;
  toy.write("scene.toml", endless());
  const pid_t process = toy.start(run);
  await_lines(toy, 2);
  kill(process, SIGTERM);
  EXPECT_EQ(toy.wait(process).code, 130);
  toy.write(name, change(toy.read(name)));
  const Toy::Result result = toy.run(std::string(run) + " --resume");
  EXPECT_EQ(result.code, 2) << result.err;
  return result.err;
}

TEST(Interrupted, AStateOrFramesInWhichOneBitHasChangedAreRefused) {
  for (const std::string name : {"out/scene.state", "out/scene.frames"}) {
    for (const double place : {0.3, 0.6, 0.999}) {
      const std::string message = message_after(name, [&](std::string bytes) {
        char& byte =
            bytes[static_cast<std::size_t>(place * static_cast<double>(bytes.size()))];
        byte = static_cast<char>(byte ^ 1);
        return bytes;
      });
      EXPECT_THAT(message, HasSubstr("checksum does not fit"));
      EXPECT_THAT(message, HasSubstr(name));
    }
  }
}

/// Three whole numbers follow the first line: frames, their checksum, strands.
TEST(Interrupted, AStateOfNoStrandsIsRefused) {
  const auto without_strands = [](std::string bytes) {
    const auto head = std::ranges::find(bytes, '\n') + 1;
    std::fill(head + 16, head + 24, '\0');
    return bytes;
  };
  EXPECT_THAT(message_after("out/scene.state", without_strands), HasSubstr("checksum"));
  // Even where the checksum, 16 digits and a blank, fits: what follows is out of place.
  const auto resealed = [&](const std::string& bytes) {
    return sealed(without_strands(bytes).substr(17));
  };
  EXPECT_THAT(message_after("out/scene.state", resealed),
              HasSubstr("the saved state is damaged"));
}

TEST(Interrupted, AStateOfAnotherCommitIsRefused) {
  const std::string message =
      message_after("out/scene.state", [](const std::string& bytes) {
        std::string content(unsealed(bytes));
        content.insert(content.find("commit") + 9, "0");
        return sealed(content);
      });
  EXPECT_THAT(message, HasSubstr("it had another commit ('0"));
}

TEST(RunKey, HoldsTheContentsOfTheFilesThatASceneNames) {
  Toy toy;
  toy.write("ball.txt", "1");
  toy.write("scene.toml", "[effects.body]\nsdf_file = \"ball.txt\"\n");
  const auto sum = [&] {
    return contents_checksum({(std::filesystem::path(toy.path("work")) / "scene.toml")});
  };
  // As TOML may write the name.
  for (const std::string name :
       {R"("ball.txt")", R"("b\u0061ll.txt")", "'ball.txt'", "'''ball.txt'''",
        "'''\nball.txt'''", "\"\"\"ball.\\\n   txt\"\"\"", R"(["x", "ball.txt"])"}) {
    toy.write("scene.toml", "[effects.body]\nsdf_file = " + name + "\n");
    toy.write("ball.txt", "1");
    const std::string before = sum();
    EXPECT_EQ(sum(), before);
    toy.write("ball.txt", "2");
    EXPECT_NE(sum(), before) << name;
  }
}

TEST(Interrupted, AGuardedRunIsNotContinuedWithoutItsGuard) {
  Toy toy;
  toy.write("scene.toml", endless());
  const pid_t process = toy.start(run);
  await_lines(toy, 2);
  kill(process, SIGTERM);
  EXPECT_EQ(toy.wait(process).code, 130);
  const Toy::Result result = toy.run(std::string(run) + " --resume --no-guard");
  EXPECT_EQ(result.code, 2);
  EXPECT_THAT(result.err, HasSubstr("it had another guard ('on', now 'off')"));
}

/// A head of four hairs, two frames.
constexpr const char* small_head =
    "title = \"four\"\nduration_s = 0.02\nframes_per_s = 100\n[integrator]\n"
    "id = \"linearly_implicit_euler\"\ndt_s = 1e-3\n[model]\nid = \"super_helix\"\n"
    "jacobian = \"elastic\"\n[material]\nname = \"hair.caucasian\"\n[groom]\n"
    "count = 4\nlength_m = 0.1\nelements = 2\n[root]\nmotion = \"fixed\"\n"
    "[effects.gravity]\n";

TEST(Simulate, TwoRunsOfAHeadWriteTheSameBytes) {
  Toy toy;
  toy.write("scene.toml", small_head);
  ASSERT_EQ(toy.run("scene.toml --as batch --out a --progress none").code, 0);
  // HDF5 counts the time of changes in whole seconds.
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));
  ASSERT_EQ(toy.run("scene.toml --as batch --out b --progress none").code, 0);
  EXPECT_TRUE(toy.read("a/scene.h5") == toy.read("b/scene.h5"));
}

/// A batch is not continued strand by strand, and the refusal costs nothing.
TEST(Interrupted, ABatchThatIsNotContinuedIsKept) {
  Toy toy;
  std::string text = small_head;
  text.replace(text.find("0.02"), 4, "100 ");
  toy.write("scene.toml", text);
  const std::string batch = "scene.toml --as batch --out out --progress none";
  const pid_t process = toy.start(batch);
  await_lines(toy, 3);
  kill(process, SIGTERM);
  ASSERT_EQ(toy.wait(process).code, 130);
  const std::string frames = toy.read("out/scene.h5");
  const Toy::Result other = toy.run("scene.toml --as strands --out out --resume");
  EXPECT_EQ(other.code, 2);
  EXPECT_THAT(other.err, HasSubstr("it had another way to run ('batch', now 'strands')"));
  EXPECT_TRUE(toy.read("out/scene.h5") == frames);
  for (const std::string ending : {".state", ".xdmf", ".csv"}) {
    EXPECT_TRUE(toy.exists("out/scene" + ending)) << ending;
  }
  const pid_t again = toy.start(batch + " --resume");
  const auto lines = std::ranges::count(toy.read("out/scene.csv"), '\n');
  await_lines(toy, static_cast<std::size_t>(lines) + 2);
  kill(again, SIGTERM);
  EXPECT_EQ(toy.wait(again).code, 130);
}

TEST(Simulate, AnOutputThatCannotBeWrittenIsRefusedBeforeAnyWork) {
  for (const std::string name : {"scene.h5", "scene.meta.json", "scene.xdmf"}) {
    for (const bool link : {true, false}) {
      Toy toy;
      toy.write("scene.toml", small_head);
      toy.write("victim", "precious");
      std::filesystem::create_directory(toy.path("work") + "/out");
      const std::string at = toy.path("work") + "/out/" + name;
      if (link) {
        std::filesystem::create_symlink("../victim", at);
      } else {
        std::filesystem::create_directory(at);
      }
      const Toy::Result result =
          toy.run("scene.toml --as batch --out out --progress none");
      EXPECT_EQ(result.code, 2);
      EXPECT_THAT(result.err, HasSubstr(link ? "is a link" : "is a directory"));
      EXPECT_EQ(toy.read("victim"), "precious");
      // Nothing else was written.
      const std::filesystem::directory_iterator out(toy.path("work") + "/out");
      EXPECT_EQ(std::distance(begin(out), end(out)), 1);
    }
  }
}

TEST(Simulate, ARefusalLeavesNoFolder) {
  Toy toy;
  toy.write("scene.toml", swinging("4", "duration_s = 0.02\nframes_per_s = 50\n"));
  const Toy::Result result = toy.run("scene.toml --hairs 3 --out new/folder");
  EXPECT_EQ(result.code, 2) << result.err;
  EXPECT_THAT(toy.files(), testing::ElementsAre("scene.toml"));
}

TEST(Simulate, OfAFullDiskAHeadSaysItInOneShortLine) {
  Toy toy;
  toy.write("scene.toml", small_head);
  const Toy::Result result =
      toy.run("scene.toml --as batch --out out --progress none", "ulimit -f 4; ");
  EXPECT_EQ(result.code, 2);
  const std::size_t begin = result.err.find("simulate: error: ");
  ASSERT_NE(begin, std::string::npos) << result.err;
  const std::string last = result.err.substr(begin);
  EXPECT_THAT(last, HasSubstr("cannot write: File too large (out/scene.h5): "));
  EXPECT_EQ(std::ranges::count(last, '\n'), 1);
  EXPECT_LT(last.size(), 200U);
}

TEST(Simulate, WhatAKilledRunLeftIsRemoved) {
  Toy toy;
  toy.write("scene.toml", swinging("4", "duration_s = 0.02\nframes_per_s = 50\n"));
  std::filesystem::create_directories(toy.path("work") + "/out/scene_vtk");
  for (const std::string name : {"scene.state", "scene.xdmf", "scene_vtk/scene_0.vtp"}) {
    toy.write("out/" + name + ".tmp999999999", "");
  }
  ASSERT_EQ(toy.run(run).code, 0);
  for (const std::string& file : toy.files()) {
    EXPECT_THAT(file, testing::Not(HasSubstr(".tmp")));
  }
}

/// With messages into a pipe that nobody reads any more.
TEST(Interrupted, NobodyNeedListenToItsProgress) {
  Toy toy;
  toy.write("scene.toml", swinging("4", "duration_s = 0.4\nframes_per_s = 50\n"));
  const std::string shell = fmt::format(
      "cd '{}' && {{ '{}' scene.toml --out out --progress json; echo $? >code; }} 2>&1 | "
      "true",
      toy.path("work"), TOY_EXPERIMENT);
  ASSERT_EQ(std::system(shell.c_str()), 0);
  EXPECT_EQ(toy.read("code"), "0\n");
}

TEST(Simulate, ASecondRunOfASceneIntoOneFolderIsRefusedWhileTheFirstRuns) {
  Toy toy;
  toy.write("scene.toml", endless());
  const pid_t process = toy.start(run);
  await_lines(toy, 2);
  Toy other;
  const std::string work = toy.path("work");
  const Toy::Result second =
      other.run("'" + work + "/scene.toml' --out '" + work + "/out'");
  EXPECT_EQ(second.code, 2);
  EXPECT_THAT(second.err, HasSubstr("another run is writing this scene"));
  kill(process, SIGINT);
  EXPECT_EQ(toy.wait(process).code, 130);
}

TEST(Simulate, TheManifestHoldsTheSceneAndItsChecksum) {
  Toy toy;
  const std::string scene = swinging("5", "duration_s = 0.02\nframes_per_s = 50\n");
  toy.write("scene.toml", scene);
  ASSERT_EQ(toy.run(run).code, 0);
  const auto meta = nlohmann::json::parse(toy.read("out/scene.meta.json"));
  ASSERT_EQ(meta.at("inputs").size(), 1U);
  EXPECT_EQ(meta.at("inputs")[0].at("file"), "scene.toml");
  EXPECT_EQ(meta.at("inputs")[0].at("text"), scene);
  EXPECT_EQ(meta.at("inputs")[0].at("fnv1a_64"), checksum(scene));
}

TEST(Files, ATemporaryFileFollowsNoLinkThatSomebodyHasPutThere) {
  Toy toy;
  toy.write("victim", "precious");
  const auto at = [&](const std::string& name) {
    return (std::filesystem::path(toy.path("work")) / name).string();
  };
  for (const std::string& ending : {std::string(), std::to_string(getpid())}) {
    std::filesystem::create_symlink("victim", at(fmt::format("table.csv.tmp{}", ending)));
  }
  replace_file(at("table.csv"), "new");
  EXPECT_EQ(toy.read("victim"), "precious");
  EXPECT_EQ(toy.read("table.csv"), "new");
  EXPECT_FALSE(std::filesystem::is_symlink(at("table.csv")));
}

/// [FNV-1a, 64 bits: test vectors of its authors.]
TEST(Checksum, IsFnv1a) {
  EXPECT_EQ(checksum(""), "cbf29ce484222325");
  EXPECT_EQ(checksum("a"), "af63dc4c8601ec8c");
  EXPECT_EQ(checksum("foobar"), "85944171f73967e8");
}

/// What changes is at the start, between two ranges that do not, and at the end; what
/// they hold is not kept.
TEST(FileState, TakesAFileBackWhateverHappenedToIt) {
  Toy toy;
  const std::string was =
      "head" + std::string(100, 'a') + "mid" + std::string(50, 'b') + "end";
  const std::string file = toy.path("work") + "/frames";
  for (const std::string& spoilt :
       {was + "more", was.substr(0, 157),
        "HEAD" + was.substr(4, 100) + "MID" + was.substr(107, 50) + "END and more"}) {
    toy.write("frames", was);
    const simulation::FileState state = simulation::state_of(file, {{107, 50}, {4, 100}});
    EXPECT_EQ(state.length, was.size());
    EXPECT_EQ(state.bytes, "headmidend");
    ASSERT_EQ(state.ranges.size(), 3U);
    toy.write("frames", spoilt);
    simulation::restore(file, state);
    EXPECT_EQ(toy.read("frames"), was);
  }
  // What does not change may reach to the end, or be nothing, or all.
  toy.write("frames", was);
  const auto kept = [&](std::vector<simulation::FileRange> unchanging) {
    return simulation::state_of(file, std::move(unchanging)).bytes.size();
  };
  EXPECT_EQ(kept({}), was.size());
  EXPECT_EQ(kept({{4, was.size() - 4}}), 4U);
  EXPECT_EQ(kept({{0, was.size()}}), 0U);
  EXPECT_THROW(simulation::state_of(toy.path("work") + "/none", {}), InputError);
  EXPECT_THROW(simulation::restore(toy.path("work") + "/none", {}), InputError);
  EXPECT_FALSE(toy.exists("none"));
}

}  // namespace tress::test_interrupted
