// Heads whose steps are taken on a device: the code for it, and the host's side of it on
// a library that stands in for the driver's (tests/device/fake_cuda.cpp).
#include <dlfcn.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "contract/input_error.h"
#include "models/effects/body.h"
#include "models/head/device_code.h"
#include "simulation/head/head_run.h"
#include "tests/harness/toy_process.h"
#include "tests/models/head/hairs.h"

namespace tress::test_device {

using namespace simulation;
using models::HeadLoss;
using models::HeadNumber;
using models::HeadPack;
using testing::HasSubstr;
using testing_support::Case;

constexpr double h = testing_support::hair_step;

const bool has_code = *models::helix_ptx != '\0';
#define NEEDS_DEVICE_CODE() \
  if (!has_code) GTEST_SKIP() << "this build found no clang for device code"

TEST(DeviceCode, IsWholeAndHasTheKernels) {
  NEEDS_DEVICE_CODE();
  const std::string ptx = models::helix_ptx;
  EXPECT_THAT(ptx, HasSubstr(".target sm_"));
  for (const char* kernel :
       {"helix_64_few", "helix_64_most", "helix_32_few", "helix_32_most"}) {
    EXPECT_THAT(ptx, HasSubstr(std::string(".visible .entry ") + kernel + "("));
  }
  // The driver links nothing: no function of CUDA's libraries, or of the C library.
  EXPECT_THAT(ptx, testing::Not(HasSubstr(".extern")));
}

/// Loaded by its path first, it is the libcuda.so.1 of this process from then on.
class OnDevice : public testing::TestWithParam<Case> {
 protected:
  void SetUp() override {
    NEEDS_DEVICE_CODE();
    static void* const fake = ::dlopen(FAKE_CUDA, RTLD_NOW);
    ASSERT_NE(fake, nullptr) << ::dlerror();
    ::unsetenv("TRESS_FAKE_CUDA");
  }
  void TearDown() override { ::unsetenv("TRESS_FAKE_CUDA"); }
};

void share(std::size_t count, const std::function<void(std::size_t)>& work) {
  for (std::size_t k = 0; k < count; ++k) work(k);
}

void advance(HeadRun& run, int from, int to) {
  for (int s = from; s < to; ++s) run.step(s * h, h);
}

TEST_P(OnDevice, StepsAreTheBitsOfTheProcessorIn64Bits) {
  HeadRun here(testing_support::head(GetParam(), {HeadNumber::float64, 4}, 19), 1);
  HeadRun there(testing_support::head(GetParam(), {HeadNumber::float64, 4}, 19), 2);
  there.move_to_device();
  const std::size_t start = here.head().hash();
  for (const auto& [from, to] : {std::pair(0, 1), std::pair(1, 60), std::pair(60, 150)}) {
    advance(here, from, to);
    advance(there, from, to);
    there.fetch();
    ASSERT_EQ(there.head().hash(), here.head().hash()) << to;
    EXPECT_NE(here.head().hash(), start);
    EXPECT_TRUE(there.lost().empty());
  }
}

// So what is known of the errors of 32 bits (tests/models/head/test_reduced_head.cpp)
// holds.
TEST_P(OnDevice, StepsAreTheBitsOfTheProcessorIn32Bits) {
  HeadRun here(testing_support::head(GetParam(), {HeadNumber::float32, 8}, 19), 1);
  HeadRun there(testing_support::head(GetParam(), testing_support::longest_floats(), 19),
                1);
  there.move_to_device();
  const std::size_t start = here.head().hash();
  advance(here, 0, 100);
  advance(there, 0, 100);
  there.fetch();
  EXPECT_EQ(there.head().hash(), here.head().hash());
  EXPECT_NE(here.head().hash(), start);
}

INSTANTIATE_TEST_SUITE_P(
    Cases, OnDevice,
    testing::Values(Case{"Curly"}, Case{.name = "Moved", .moves = true},
                    Case{.name = "BendingOnly", .twist = false, .moves = true},
                    Case{.name = "OneElement", .elements = 1, .points = 12},
                    // More than the smaller kernel holds.
                    Case{.name = "Fine", .elements = 40, .points = 4, .moves = true},
                    // Elements wind by up to 3 and by up to 6 rad: other formulas.
                    Case{.name = "Tight", .points = 12, .curl = 5},
                    Case{.name = "Tightest", .points = 16, .curl = 11},
                    Case{.name = "InVacuum", .drag = 0, .mass_damping = 0}),
    [](const auto& of) { return of.param.name; });

using Device = OnDevice;

/// The rate of an unknown of this strand is no number.
void spoil(Head& head, std::size_t strand) {
  const std::size_t block = strand / head.strands_of(0);
  std::vector<double> x(head.kept() * head.strands_of(block));
  head.keep(block, x);
  x[head.kept() * (strand % head.strands_of(0)) + 4] =
      std::numeric_limits<double>::quiet_NaN();
  head.recall(block, x);
}

TEST_F(Device, LosesTheSameStrandsInTheSameStepsAndKeepsThem) {
  const Case c{.name = "Moved", .moves = true};
  const HeadPack pack = testing_support::longest_doubles();
  HeadRun here(testing_support::head(c, pack, 21), 1);
  HeadRun there(testing_support::head(c, pack, 21), 3);
  there.move_to_device();
  advance(here, 0, 10);
  advance(there, 0, 10);
  there.fetch();
  for (HeadRun* run : {&here, &there}) {
    spoil(run->change(), 17);
    spoil(run->change(), 3);
    run->change().lose(5);
  }
  std::vector<HeadLoss> want;
  for (int s = 10; s < 30; ++s) {
    here.step(s * h, h);
    want.insert(want.end(), here.lost().begin(), here.lost().end());
    there.step(s * h, h);
  }
  there.fetch();
  ASSERT_EQ(want.size(), 2U);
  ASSERT_EQ(there.lost().size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(there.lost()[k].strand, want[k].strand);
    EXPECT_EQ(there.lost()[k].step, want[k].step);
    EXPECT_NEAR(there.lost()[k].time, want[k].time, 1e-15);
    EXPECT_EQ(there.lost()[k].reason, want[k].reason);
  }
  for (std::size_t k = 0; k < 21; ++k) {
    EXPECT_EQ(there.head().lost(k), here.head().lost(k));
    EXPECT_EQ(there.head().lost(k), k == 3 || k == 5 || k == 17);
  }
  // Told once, and where they were.
  advance(here, 30, 40);
  advance(there, 30, 40);
  there.fetch();
  EXPECT_TRUE(there.lost().empty());
  std::vector<double> x, y;
  here.positions(40 * h, x);
  there.positions(40 * h, y);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const std::size_t strand = i / there.head().numbers();
    if (strand == 3 || strand == 17) continue;  // their places are no numbers
    ASSERT_EQ(x[i], y[i]) << strand;
  }
}

TEST_F(Device, SlicesOnTwoStreamsGiveTheSameBits) {
  const Case c{.name = "Moved", .moves = true};
  std::size_t want = 0;
  for (const std::size_t strands : {1000U, 16U, 7U}) {
    const auto head = testing_support::head(c, {HeadNumber::float64, 4}, 83);
    const auto device = device_head(*head, strands);
    for (int s = 0; s < 20; ++s) {
      device->step(s * h, h);
      if (s % 7 == 6) {
        EXPECT_TRUE(device->fetch(share).empty());
      }
    }
    EXPECT_TRUE(device->fetch(share).empty());
    if (want == 0) want = head->hash();
    EXPECT_EQ(head->hash(), want) << strands;
  }
  const auto head = testing_support::head(c, {HeadNumber::float64, 4}, 83);
  testing_support::advance(*head, 20);
  EXPECT_EQ(head->hash(), want);
}

TEST_F(Device, MoreStepsThanALaunchHolds) {
  const Case c{.name = "Short", .elements = 1, .points = 4, .moves = true};
  HeadRun here(testing_support::head(c, {HeadNumber::float64, 4}, 4), 1);
  HeadRun there(testing_support::head(c, {HeadNumber::float64, 4}, 4), 1);
  there.move_to_device();
  advance(here, 0, 5000);
  advance(there, 0, 5000);
  there.fetch();
  EXPECT_EQ(there.head().hash(), here.head().hash());
}

TEST_F(Device, AHeadIsAsItWasWhereTheDeviceFails) {
  const Case c{"Curly"};
  HeadRun run(testing_support::head(c, {HeadNumber::float64, 4}, 19), 1);
  run.move_to_device();
  advance(run, 0, 5);
  run.fetch();
  const std::size_t before = run.head().hash();
  advance(run, 5, 10);
  // The next of all launches in this process.
  ::setenv("TRESS_FAKE_CUDA", "launch=next", 1);
  try {
    run.fetch();
    FAIL() << "it did not fail";
  } catch (const DeviceFailure& failure) {
    EXPECT_THAT(failure.what(), HasSubstr("cuLaunchKernel failed: "
                                          "CUDA_ERROR_LAUNCH_FAILED (719)"));
  }
  EXPECT_EQ(run.head().hash(), before);
}

/// What the head is refused with.
std::string refusal(std::unique_ptr<Head> head) {
  HeadRun run(std::move(head), 1);
  try {
    run.move_to_device();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST_F(Device, RefusesWhatItsCodeDoesNotKnow) {
  const HeadPack pack{HeadNumber::float64, 4};
  EXPECT_EQ(refusal(testing_support::head({"Curly"}, pack, 4)), "");
  EXPECT_EQ(refusal(testing_support::head({.name = "Most", .elements = 64}, pack, 4)),
            "");
  EXPECT_THAT(refusal(testing_support::head({.name = "More", .elements = 65}, pack, 4)),
              HasSubstr("up to 64 elements a strand, not 65"));
  Case c{"Body"};
  c.effects = {std::make_shared<models::Body>(
      models::Ellipsoid({0.1, 0.1, 0.1}), models::StrandPlace{},
      models::BodyContact{.stiffness = 10, .damping = 1, .friction = 0, .offset = 0},
      models::RootMotion{})};
  EXPECT_THAT(refusal(testing_support::head(c, pack, 4)),
              HasSubstr("gravity and linear drag only, not bodies"));
  c.effects = {};
  c.own = [](std::size_t) {
    return models::Effects{std::make_shared<models::Gravity>(Vec{0, 0, 1})};
  };
  EXPECT_THAT(refusal(testing_support::head(c, pack, 4)), HasSubstr("single strands"));
  for (const auto& make : {simulation::der_head, simulation::chain_head}) {
    EXPECT_THAT(refusal(make(testing_support::options({"Others"}), pack)),
                HasSubstr("only for uniform strands of super_helix with "
                          "linearly_implicit_euler and jacobian = "
                          "\"elastic\""));
  }
}

/// Lines beside those that say what is computed.
int errors_in(const std::string& text) {
  int found = 0;
  for (std::size_t at = 0; (at = text.find("error: ", at)) != std::string::npos; ++at) {
    ++found;
  }
  return found;
}

/// `simulate` with the stand-in as libcuda.so.1.
class SimulateOnDevice : public testing::Test {
 protected:
  void SetUp() override {
    NEEDS_DEVICE_CODE();
    toy.write("head.toml", scene("[effects.gravity]\n[effects.linear_drag]\n"));
    toy.write("windy.toml", scene("[effects.gravity]\n[effects.wind]\n"));
  }
  static std::string scene(const std::string& effects,
                           const std::string& duration = "0.1",
                           const std::string& step = "0.004") {
    return "title = \"head\"\nduration_s = " + duration +
           "\nframes_per_s = 20\n[model]\nid = "
           "\"super_helix\"\njacobian = \"elastic\"\n[integrator]\nid = "
           "\"linearly_implicit_euler\"\ndt_s = " +
           step +
           "\n[material]\nname = "
           "\"hair.caucasian\"\n[groom]\ncount = 21\nelements = 6\nlength_m = "
           "0.1\n[root]\nmotion = \"rotate\"\naxis = [0, 0, 1]\nangle_rad = 0.5\n" +
           effects;
  }
  Toy::Result run(const std::string& arguments, const std::string& fails = "",
                  const std::string& folder =
                      std::filesystem::path(FAKE_CUDA).parent_path().string()) {
    return toy.run(
        arguments + " --as batch --out out --progress none",
        "export TRESS_FAKE_CUDA='" + fails + "' LD_LIBRARY_PATH='" + folder + "';");
  }
  nlohmann::json outcome(const std::string& name) const {
    return nlohmann::json::parse(toy.read("out/" + name + ".meta.json")).at("outcome");
  }
  Toy toy;
};

TEST_F(SimulateOnDevice, GivesTheStateOfTheProcessorAndSaysWhereItRan) {
  ASSERT_EQ(run("head.toml").code, 0);
  const std::string want = outcome("head").at("state_hash");
  EXPECT_EQ(outcome("head").at("device"), "cpu");
  for (const char* device : {"gpu", "auto"}) {
    const Toy::Result there = run(std::string("head.toml --device ") + device);
    ASSERT_EQ(there.code, 0) << there.err;
    EXPECT_EQ(outcome("head").at("state_hash"), want);
    EXPECT_EQ(outcome("head").at("device"), "no device (host twin)");
    EXPECT_THAT(there.err, HasSubstr("head: on no device (host twin)"));
  }
}

TEST_F(SimulateOnDevice, GoesOnWithoutItOrEndsInOneLine) {
  ASSERT_EQ(run("head.toml").code, 0);
  const std::string want = outcome("head").at("state_hash");
  const std::string broken = toy.path("broken");
  std::filesystem::create_directory(broken);
  std::ofstream(broken + "/libcuda.so.1") << "no library";
  const auto judge = [&](const std::string& fails, const std::string& folder,
                         const std::string& reason) {
    SCOPED_TRACE(reason);
    const Toy::Result asked = run("head.toml --device gpu", fails, folder);
    EXPECT_EQ(asked.code, 2);
    EXPECT_EQ(errors_in(asked.err), 1) << asked.err;
    EXPECT_THAT(asked.err, HasSubstr(reason));
    EXPECT_THAT(asked.err, HasSubstr("--device cpu"));
    const Toy::Result open = run("head.toml --device auto", fails, folder);
    EXPECT_EQ(open.code, 0) << open.err;
    EXPECT_THAT(open.err, HasSubstr("stays on the processor: "));
    EXPECT_THAT(open.err, HasSubstr(reason));
    EXPECT_EQ(outcome("head").at("state_hash"), want);
    EXPECT_EQ(outcome("head").at("device"), "cpu");
  };
  const std::string fake = std::filesystem::path(FAKE_CUDA).parent_path().string();
  judge("", broken, "no driver of NVIDIA: ");
  judge("no_device", fake, "the driver has no device");
  judge("no_memory", fake, "cuMemAlloc failed: CUDA_ERROR_OUT_OF_MEMORY (2)");
  judge("bad_image", fake, "cuModuleLoadData failed: CUDA_ERROR_INVALID_PTX (218)");
  judge("launch=1", fake, "cuLaunchKernel failed: CUDA_ERROR_LAUNCH_FAILED (719)");
}

// Frames of one step each: the last step of a frame may lose strands.
TEST_F(SimulateOnDevice, NamesAFailedStrandOnceWhereverItRuns) {
  toy.write(
      "lossy.toml",
      scene("[effects.gravity]\ngravity_m_s2 = [0, 0, -1e5]\n[effects.linear_drag]\n"
            "[groom.material]\nyoungs_modulus_pa = 1e3\n",
            "3", "0.05"));
  for (const std::string scene : {"lossy.toml", "lossy.toml --no-guard"}) {
    ASSERT_EQ(run(scene).code, 3);
    const std::string want = toy.read("out/lossy.failed.csv");
    EXPECT_GT(outcome("lossy").at("failed_strands"), 0);
    for (const char* fails : {"no_device", ""}) {
      EXPECT_EQ(run(scene + " --device auto", fails).code, 3);
      EXPECT_EQ(toy.read("out/lossy.failed.csv"), want) << scene << fails;
    }
  }
}

TEST_F(SimulateOnDevice, EndsInOneLineWhereTheDeviceFailsOnItsWay) {
  for (const char* device : {"gpu", "auto"}) {
    const Toy::Result result =
        run(std::string("head.toml --device ") + device, "launch=2");
    EXPECT_EQ(result.code, 2);
    EXPECT_EQ(errors_in(result.err), 1) << result.err;
    EXPECT_THAT(result.err, HasSubstr("CUDA_ERROR_LAUNCH_FAILED"));
  }
}

TEST_F(SimulateOnDevice, SaysWhichScenesItDoesNotKnow) {
  const Toy::Result asked = run("windy.toml --device gpu");
  EXPECT_EQ(asked.code, 2);
  EXPECT_THAT(asked.err, HasSubstr("gravity and linear drag only, not effect wind"));
  const Toy::Result open = run("windy.toml --device auto");
  EXPECT_EQ(open.code, 0) << open.err;
  EXPECT_THAT(open.err, HasSubstr("gravity and linear drag only, not effect wind"));
  const Toy::Result strands =
      toy.run("head.toml --as strands --device gpu --out out --progress none");
  EXPECT_EQ(strands.code, 2);
  EXPECT_THAT(strands.err, HasSubstr("give --as batch, or --device cpu"));
}

/// `scaling`, the same.
class ScalingOnDevice : public SimulateOnDevice {
 protected:
  Toy::Result scaling(const std::string& arguments, const std::string& fails = "") {
    const auto file = [this](const char* name) { return toy.path("work/") + name; };
    const std::string command =
        "cd '" + toy.path("work") + "' && TRESS_FAKE_CUDA='" + fails +
        "' LD_LIBRARY_PATH='" + std::filesystem::path(FAKE_CUDA).parent_path().string() +
        "' '" SCALING "' " + arguments +
        " --quick --progress none --out table.csv >out.txt 2>err.txt";
    const int status = std::system(command.c_str());
    const auto text = [](const std::string& name) {
      std::ifstream stream(name);
      return std::string(std::istreambuf_iterator<char>(stream), {});
    };
    return {WEXITSTATUS(status), text(file("table.csv")), text(file("err.txt"))};
  }
};

TEST_F(ScalingOnDevice, StepsAHeadThereOrSaysWhyNot) {
  const std::string head = "--scene '" + toy.path("work/head.toml") + "' --device ";
  for (const std::string device : {"gpu", "auto"}) {
    const Toy::Result there = scaling(head + device);
    EXPECT_EQ(there.code, 0) << there.err;
    EXPECT_THAT(there.out, HasSubstr(",no device (host twin),"));
  }
  const Toy::Result asked = scaling(head + "gpu", "no_device");
  EXPECT_EQ(asked.code, 3);
  EXPECT_THAT(asked.err, HasSubstr("the driver has no device"));
  const Toy::Result open = scaling(head + "auto", "no_device");
  EXPECT_EQ(open.code, 0) << open.err;
  EXPECT_THAT(open.out, HasSubstr("cpu; the driver has no device"));
  const Toy::Result strands = scaling("--device gpu");
  EXPECT_EQ(strands.code, 2);
  EXPECT_EQ(errors_in(strands.err), 1) << strands.err;
  EXPECT_THAT(strands.err, HasSubstr("give --scene groom.toml, or --device cpu"));
}

}  // namespace tress::test_device
