#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/harness/toy_process.h"

namespace tress::test_bad_input {

using testing::HasSubstr;
using testing::IsEmpty;

struct BadInput {
  std::string name, arguments, place, remedy;
  std::string scene = {};  // content of scene.toml, if any
};

void PrintTo(const BadInput& bad, std::ostream* out) { *out << bad.arguments; }

class BadInputTest : public testing::TestWithParam<BadInput> {};

TEST_P(BadInputTest, IsOneLineWithPlaceAndRemedyAndExitCodeTwoAndNothingWritten) {
  const BadInput& bad = GetParam();
  Toy toy;
  if (!bad.scene.empty()) toy.write("scene.toml", bad.scene);
  const auto before = toy.files();
  const Toy::Result result = toy.run(bad.arguments);
  EXPECT_EQ(result.code, 2) << result.err;
  EXPECT_EQ(result.error_lines(), 1) << result.err;
  EXPECT_THAT(result.err, HasSubstr(bad.place));
  EXPECT_THAT(result.err, HasSubstr(bad.remedy));
  EXPECT_EQ(toy.files(), before);
  EXPECT_THAT(toy.executed(), IsEmpty());
  EXPECT_EQ(result.out, "");
}

std::string dotted_key(int levels) {
  std::string key = "a";
  for (int i = 1; i < levels; ++i) key += ".a";
  return key;
}

const BadInput bad_inputs[] = {
    {"UnknownModel", "--models no_such_model", "(--models)", "--list shows"},
    {"UnknownIntegrator", "--integrators no_such_one", "(--integrators)", "--list shows"},
    {"UnknownKey", "--set particels=3", "(--set particels=3)",
     "did you mean 'particles'?"},
    {"UnknownOption", "--elments 3", "command line", "did you mean '--elements'?"},
    {"StrayWord", "run", "command line", "--help shows"},
    {"MissingValue", "--set", "command line", "--help shows"},
    {"NegativeTimeStep", "--set dt=-0.1", "(--set dt=-0.1)", "give a number between"},
    {"NegativeIntegratorStep", "--set step=-1", "(--set step=-1)",
     "give a number between"},
    {"AlphaNotANumber", "--set alpha=NaN", "(--set alpha=NaN)", "give a number"},
    {"ZeroParticles", "--set particles=0", "(--set particles=0)", "between 1 and"},
    {"HalfAParticle", "--set particles=1.5", "(--set particles=1.5)", "whole number"},
    {"WordOutsideChoices", "--set linear=kul", "(--set linear=kul)",
     "use one of: automatic"},
    {"SettingWithoutValue", "--set dt", "(--set dt)", "give key=value"},
    {"EmptyOutput", "--out ''", "(--out)", "leave the option out"},
    {"UnusedOption", "--repeat 2", "(--repeat)", "leave it out"},
    {"SceneUnusedOption", "--options scene.toml", "(scene.toml:1:", "leave it out",
     "repeat = 2\n"},
    {"EmptyModels", "--models ''", "(--models)", "leave the option out"},
    {"SettingTwice", "--set dt=1 --set dt=0.5", "(--set dt=0.5)", "set it once"},
    {"OutputIsADirectory", "--out .", "(--out .)", "give a file name"},
    {"OutputDirectoryMissing", "--out none/toy.csv", "(--out none/toy.csv)", "mkdir -p"},
    {"OutputUnwritable", "--out /proc/toy.csv", "/proc/toy.csv", "writable directory"},
    {"OutputIsADevice", "--out /dev/full", "(--out /dev/full)", "give a .csv file"},
    {"ResumeFromStandardOutput", "--out - --resume", "(--resume)", "--out file.csv"},
    {"BadElements", "--elements 3:1", "(--elements)", "ascending"},
    {"ZeroElements", "--elements 0", "(--elements)", "from 1 to"},
    {"BadDuration", "--timeout soon", "(--timeout)", "as in 10m"},
    {"EndlessDuration", "--timeout 1e10", "(--timeout)", "give 1ms to"},
    {"BadShard", "--shard 3/2", "(--shard)", "as in 2/5"},
    {"NoJobs", "--jobs 0", "(--jobs)", "from 1 to"},
    {"QuickAndFull", "--quick --full", "(command line)", "give one of them"},
    {"MergeWithoutOutput", "--merge a.csv b.csv", "(--merge)", "give --out"},
    {"MergeOfMissingTable", "--merge a.csv --out c.csv", "(a.csv)", "existing"},
    {"SceneMissing", "--options none.toml", "(none.toml)", "existing"},
    {"SceneIsADevice", "--options /dev/zero", "(/dev/zero)", "readable file"},
    {"SceneIsAFolder", "--options .", "is a directory (.)", "readable file"},
    {"SceneDeepKey", "--options scene.toml", "(scene.toml:2:", "nest less deeply",
     "seed = 1\n" + dotted_key(31'000) + " = 1\n"},
    {"SceneMalformed", "--options scene.toml", "(scene.toml:2:", "correct the TOML",
     "seed = 1\nmodels = [\n"},
    {"SceneKeyTwice", "--options scene.toml", "(scene.toml:2:", "correct the TOML",
     "seed = 1\nseed = 2\n"},
    {"SceneUnknownKey", "--options scene.toml", "(scene.toml:2:1)",
     "did you mean 'elements'?", "seed = 1\nelemets = [1]\n"},
    {"SceneWrongType", "--options scene.toml", "(scene.toml:1:9)", "give true or false",
     "quick = 1\n"},
    {"SceneUnknownSetting", "--options scene.toml",
     "(scene.toml:2:", "did you mean 'dt'?", "[settings]\ndtt = 0.1\n"},
    {"SceneNegativeStep", "--options scene.toml", "(scene.toml:2:6)",
     "give a number between", "[settings]\ndt = -0.1\n"},
    {"SceneAlphaNotANumber", "--options scene.toml", "(scene.toml:2:9)", "give a number",
     "[settings]\nalpha = nan\n"},
    {"SceneUnknownModel", "--options scene.toml", "(scene.toml:1:", "--list shows",
     "models = [\"no_such_model\"]\n"},
    {"SceneNulByte", "--options scene.toml", "(scene.toml:2:2)", "plain text",
     std::string("seed = 1\n[\0\0[", 13)},
};

INSTANTIATE_TEST_SUITE_P(Harness, BadInputTest, testing::ValuesIn(bad_inputs),
                         [](const auto& run) { return run.param.name; });

TEST(BadInput, FullDeviceOnStandardOutputIsSeenBeforeAnyWork) {
  Toy toy;
  const Toy::Result result = toy.run("--out -", "", "/dev/full");
  EXPECT_EQ(result.code, 2);
  EXPECT_EQ(result.error_lines(), 1) << result.err;
  EXPECT_THAT(result.err, HasSubstr("free space"));
  EXPECT_THAT(toy.executed(), IsEmpty());
}

}  // namespace tress::test_bad_input
