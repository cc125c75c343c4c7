#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "contract/input_error.h"
#include "experiments/run/command_line.h"
#include "experiments/run/settings.h"
#include "integrators/integrator_options.h"
#include "simulation/files/parse.h"

namespace tress::test_command_line {

using namespace experiments;

using testing::ElementsAre;

CommandLine parse(std::vector<const char*> arguments) {
  arguments.insert(arguments.begin(), "toy");
  return parse_command_line("toy", "question", "example",
                            static_cast<int>(arguments.size()), arguments.data());
}

TEST(CommandLine, DefaultsAreOneJobTenMinutesThreeRepeats) {
  const CommandLine line = parse({});
  EXPECT_EQ(line.jobs, 1);
  EXPECT_EQ(line.timeout_s, 600);
  EXPECT_EQ(line.repeat, 3);
  EXPECT_EQ(line.out, "results/toy.csv");
  EXPECT_TRUE(line.models.empty());
}

TEST(CommandLine, EveryOptionIsUnderstood) {
  const CommandLine line = parse({"--models",
                                  "a,b",
                                  "--integrators",
                                  "c",
                                  "--elements",
                                  "1,2,5,10:40:10",
                                  "--set",
                                  "x=1",
                                  "--set",
                                  "y=z=2",
                                  "--out",
                                  "-",
                                  "--quick",
                                  "--jobs",
                                  "2",
                                  "--shard",
                                  "2/3",
                                  "--timeout",
                                  "90s",
                                  "--repeat",
                                  "5",
                                  "--seed",
                                  "18446744073709551615",
                                  "--progress",
                                  "none"});
  EXPECT_THAT(line.models, ElementsAre("a", "b"));
  EXPECT_THAT(line.integrators, ElementsAre("c"));
  EXPECT_THAT(line.elements, ElementsAre(1, 2, 5, 10, 20, 30, 40));
  EXPECT_THAT(line.set, ElementsAre(testing::Pair("x", "1"), testing::Pair("y", "z=2")));
  EXPECT_EQ(line.out, "-");
  EXPECT_TRUE(line.quick);
  EXPECT_EQ(line.jobs, 2);
  EXPECT_EQ(line.shard_index, 2);
  EXPECT_EQ(line.shard_count, 3);
  EXPECT_EQ(line.timeout_s, 90);
  EXPECT_EQ(line.repeat, 5);
  EXPECT_EQ(line.seed, 18446744073709551615u);
  EXPECT_EQ(line.progress, ProgressMode::none);
}

TEST(CommandLine, ShardsHaveTheirOwnDefaultTable) {
  EXPECT_EQ(parse({"--shard", "1/4", "--out", "a.b/x.csv"}).out, "a.b/x.1-of-4.csv");
  EXPECT_EQ(parse({"--shard", "1/4", "--out", "-"}).out, "-");
  EXPECT_EQ(parse({"--shard", "1/4"}).out, "results/toy.1-of-4.csv");
}

TEST(Parse, CountsAreListsAndRangesWithoutRepeats) {
  EXPECT_THAT(parse_counts("3", "x"), ElementsAre(3));
  EXPECT_THAT(parse_counts("4:6", "x"), ElementsAre(4, 5, 6));
  EXPECT_THAT(parse_counts("10:35:10", "x"), ElementsAre(10, 20, 30));
  EXPECT_THAT(parse_counts("5, 1,4:5", "x"), ElementsAre(5, 1, 4));
  for (const char* bad : {"", "a", "1,,2", "0", "-1", "1.5", "3:1", "1:2:0", "1:2:3:4",
                          "1:9999999", "99999999999999999999"}) {
    EXPECT_THROW(parse_counts(bad, "x"), InputError) << bad;
  }
}

TEST(Parse, AFileMayHaveCommasInItsName) {
  EXPECT_THAT(listed_files("a.toml, b.toml", "x"), ElementsAre("a.toml", "b.toml"));
  const std::string name = testing::TempDir() + "a,b.toml";
  std::ofstream(name) << "\n";
  EXPECT_THAT(listed_files(name, "x"), ElementsAre(name));
  std::filesystem::remove(name);
  EXPECT_EQ(listed_files(name, "x").size(), 2U);
  EXPECT_THROW(listed_files("a,,b", "x"), InputError);
}

TEST(Parse, DurationsHaveUnits) {
  EXPECT_EQ(parse_duration("10m", "x"), 600);
  EXPECT_EQ(parse_duration("2h", "x"), 7200);
  EXPECT_EQ(parse_duration("1.5s", "x"), 1.5);
  EXPECT_EQ(parse_duration("250ms", "x"), 0.25);
  EXPECT_EQ(parse_duration("3", "x"), 3);
  for (const char* bad :
       {"", "m", "-1s", "0", "nan", "inf", "1d", "1 m", "1e10", "1e300h", "1e-9"}) {
    EXPECT_THROW(parse_duration(bad, "x"), InputError) << bad;
  }
}

TEST(IntegratorOptions, EveryDeclaredKeyReachesItsField) {
  Options o;
  apply(o, "alpha", "100", "x");
  apply(o, "beta", "20", "x");
  apply(o, "step", "0.01", "x");
  apply(o, "rtol", "1e-4", "x");
  apply(o, "atol", "1e-5", "x");
  apply(o, "max_order", "2", "x");
  apply(o, "newton_tolerance", "1e-8", "x");
  apply(o, "newton_iterations", "7", "x");
  apply(o, "refresh", "when_slow", "x");
  apply(o, "newton_coefficient", "0.25", "x");
  apply(o, "linear", "banded", "x");
  apply(o, "formulation", "index2_ggl", "x");
  apply(o, "max_steps", "50", "x");
  apply(o, "max_step", "0.5", "x");
  apply(o, "max_work", "1e7", "x");
  EXPECT_EQ(o.alpha, 100);
  EXPECT_EQ(o.beta, 20);
  EXPECT_EQ(o.step, 0.01);
  EXPECT_EQ(o.rtol, 1e-4);
  EXPECT_EQ(o.atol, 1e-5);
  EXPECT_EQ(o.max_order, 2);
  EXPECT_EQ(o.newton_tolerance, 1e-8);
  EXPECT_EQ(o.newton_iterations, 7);
  EXPECT_EQ(o.refresh, Refresh::when_slow);
  EXPECT_EQ(o.newton_coefficient, 0.25);
  EXPECT_EQ(o.linear, LinearKind::banded);
  EXPECT_EQ(o.formulation, Formulation::index2_ggl);
  EXPECT_EQ(o.max_steps, 50);
  EXPECT_EQ(o.max_step, 0.5);
  EXPECT_EQ(o.max_work, 1e7);
}

TEST(IntegratorOptions, DeclaredDefaultsAreThoseOfOptions) {
  const Options original;
  for (const Parameter& p : common_options()) {
    if (!p.choices.empty()) continue;
    Options o;
    std::string text(32, ' ');
    text.resize(static_cast<std::size_t>(
        std::snprintf(text.data(), text.size(), "%.17g", p.number)));
    apply(o, p.name, text, "x");
    EXPECT_EQ(o.alpha, original.alpha);
    EXPECT_EQ(o.step, original.step) << p.name;
    EXPECT_EQ(o.rtol, original.rtol) << p.name;
    EXPECT_EQ(o.atol, original.atol) << p.name;
    EXPECT_EQ(o.max_steps, original.max_steps) << p.name;
    EXPECT_EQ(o.max_work, original.max_work) << p.name;
    EXPECT_EQ(o.newton_iterations, original.newton_iterations) << p.name;
    EXPECT_EQ(o.newton_tolerance, original.newton_tolerance) << p.name;
  }
}

// Methods that read one key share its declaration.
TEST(IntegratorOptions, EveryKeyIsDeclaredOnce) {
  std::set<std::string_view> names;
  for (const Parameter& p : integrator_options()) {
    EXPECT_TRUE(names.insert(p.name).second) << p.name;
  }
}

TEST(IntegratorOptions, OwnOnesReachTheMethodThatDeclaresThem) {
  int own = 0;
  for (const IntegratorEntry& entry : integrator_catalogue()) {
    for (const Parameter& p : entry.parameters) {
      ++own;
      EXPECT_EQ(std::ranges::count(readers_of_option(p.name), &entry), 1) << p.name;
      const bool number = p.choices.empty() && !p.text;
      std::string text = "other";
      if (!p.choices.empty()) text = words_of(p.choices).back();
      if (number) text = std::to_string(p.number > 0.5 ? 0.5 * p.number : 1);
      if (p.whole) text = "7";
      Options options;
      apply(options, p.name, text, "x");
      const Parameters read = own_options(options, entry.parameters);
      const Parameters defaults = own_options({}, entry.parameters);
      if (number) {
        EXPECT_EQ(read.number(p.name), std::stod(text)) << p.name;
        EXPECT_EQ(defaults.number(p.name), p.number) << p.name;
      } else {
        EXPECT_EQ(read.word(p.name), text) << p.name;
        EXPECT_EQ(defaults.word(p.name), p.default_text()) << p.name;
      }
    }
  }
  EXPECT_GT(own, 0);
  Options options;
  EXPECT_THROW(apply(options, "rho_inf", "2", "x"), InputError);
  EXPECT_THROW(apply(options, "sweep_order", "upwards", "x"), InputError);
}

TEST(Settings, AnOptionOfAMethodThatIsNotChosenIsRefusedWithItsOwner) {
  const auto options_of = [](const char* integrators) {
    return Settings(parse({"--integrators", integrators, "--set", "rho_inf=0.5"}), {})
        .options();
  };
  EXPECT_EQ(options_of("rk4,generalized_alpha").own.at("rho_inf"), "0.5");
  try {
    options_of("rk4,newmark");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("rho_inf belongs to generalized_alpha"));
  }
}

TEST(Settings, TheExperimentsOwnKeysComeBeforeTheIntegrators) {
  constexpr Parameter own[] = {{.name = "alpha", .help = "mine", .number = 3}};
  const CommandLine line = parse({"--set", "alpha=5", "--set", "beta=7"});
  const Settings settings(line, own);
  EXPECT_EQ(settings.experiment().number("alpha"), 5);
  EXPECT_EQ(settings.options().alpha, 0);
  EXPECT_EQ(settings.options().beta, 7);
  EXPECT_TRUE(settings.chosen("beta"));
  EXPECT_FALSE(settings.chosen("step"));
}

TEST(Settings, OptionsKeepWhatTheExperimentPresets) {
  const CommandLine line = parse({"--set", "beta=7"});
  const Settings settings(line, {});
  Options start;
  start.step = 0.125;
  EXPECT_EQ(settings.options(start).step, 0.125);
  EXPECT_EQ(settings.options(start).beta, 7);
}

}  // namespace tress::test_command_line
