#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <nlohmann/json.hpp>

#include "simulation/files/build_facts.h"
#include "simulation/files/checksum.h"
#include "simulation/files/csv.h"
#include "tests/harness/toy_process.h"

namespace tress::test_sweep {

using namespace simulation;

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

CsvTable table(const Toy& toy, const std::string& file) {
  return parse_csv(toy.read(file), file);
}

std::vector<std::string> cells(const CsvTable& of, const std::string& column) {
  std::vector<std::string> result;
  for (const Row& row : of.rows) result.emplace_back(row.text(column));
  return result;
}

TEST(Sweep, WritesEveryRowInOrderWithManifestAndRemovesTheJournal) {
  Toy toy;
  const Toy::Result result = toy.run("--out toy.csv --jobs 3");
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(toy.files(), ElementsAre("toy.csv", "toy.meta.json"));
  const CsvTable rows = table(toy, "toy.csv");
  EXPECT_THAT(rows.header, ElementsAre("index", "dt_s", "square", "wall_s", "others_load",
                                       "status", "reason", "run_id"));
  EXPECT_THAT(cells(rows, "others_load"), ElementsAre("", "", "", ""));
  EXPECT_THAT(cells(rows, "index"), ElementsAre("0", "1", "2", "3"));
  EXPECT_THAT(cells(rows, "square"), ElementsAre("0", "1", "4", "9"));
  EXPECT_THAT(cells(rows, "status"), ElementsAre("ok", "ok", "ok", "ok"));
}

TEST(Sweep, RowsThatRunAloneHaveTheLoadOfOthers) {
  Toy toy;
  ASSERT_EQ(toy.run("--out toy.csv --jobs 1").code, 0);
  for (const std::string& load : cells(table(toy, "toy.csv"), "others_load")) {
    EXPECT_GE(std::stod(load), 0);
  }
}

TEST(Sweep, DefaultOutputIsResultsSlashName) {
  Toy toy;
  EXPECT_EQ(toy.run("").code, 0);
  EXPECT_THAT(toy.files(),
              ElementsAre("results", "results/toy.csv", "results/toy.meta.json"));
}

TEST(Sweep, ManifestSaysHowTheTableWasMade) {
  Toy toy;
  ASSERT_EQ(toy.run("--out toy.csv --seed 42 --set dt=0.5").code, 0);
  const auto meta = nlohmann::json::parse(toy.read("toy.meta.json"));
  EXPECT_EQ(meta.at("seed"), 42);
  EXPECT_EQ(meta.at("rows").at("by_status").at("ok"), 4);
  EXPECT_GT(meta.at("sundials_speed_ratio").get<double>(), 0);
  EXPECT_NE(meta.at("machine").at("kernel"), "");
  EXPECT_NE(meta.at("build").at("compiler"), "");
  EXPECT_NE(meta.at("git").at("commit"), "");
  EXPECT_THAT(meta.at("argv").size(), 7u);
  EXPECT_THAT(meta.at("libraries").at("eigen").get<std::string>(), HasSubstr("3."));
}

struct OddRow {
  std::string name, status, reason;
};

class OddRowTest : public testing::TestWithParam<OddRow> {};

TEST_P(OddRowTest, BecomesARowWithReasonBesideCompleteNeighbours) {
  const OddRow& odd = GetParam();
  Toy toy;
  const auto start = std::chrono::steady_clock::now();
  // Rows that end by themselves are given their time: a sanitizer writes long reports.
  const std::string timeout = odd.status == "timeout" ? "300ms" : "30s";
  const Toy::Result result =
      toy.run("--out toy.csv --timeout " + timeout + " --set odd_row=" + odd.name);
  // Not a timing: a hang that nobody ends would last for ever.
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(60));
  EXPECT_EQ(result.code, 3);
  const CsvTable rows = table(toy, "toy.csv");
  EXPECT_THAT(cells(rows, "status"), ElementsAre("ok", "ok", odd.status, "ok"));
  EXPECT_THAT(cells(rows, "reason")[2], HasSubstr(odd.reason));
  EXPECT_THAT(cells(rows, "index"), ElementsAre("0", "1", "2", "3"));
  EXPECT_FALSE(toy.exists("toy.csv.journal"));
}

const OddRow odd_rows[] = {
    {"crash", "crashed", ""},  // a sanitizer turns the signal into an exit code
    {"quit", "crashed", "exit code 7"},
    {"throw", "exception", "row 2, \"as asked\",\nthrew"},
    {"busy", "timeout", "killed after 0.3 s"},
    {"deaf", "timeout", "killed after 0.3 s"},
    {"polite", "timeout", "stopped at t = 1 s"},
};
INSTANTIATE_TEST_SUITE_P(Harness, OddRowTest, testing::ValuesIn(odd_rows),
                         [](const auto& run) { return run.param.name; });

TEST(Sweep, ACaseThatHonoursItsDeadlineKeepsWhatItMeasured) {
  Toy toy;
  static_cast<void>(toy.run("--out toy.csv --timeout 300ms --set odd_row=polite"));
  EXPECT_EQ(cells(table(toy, "toy.csv"), "square")[2], "1");
}

TEST(Sweep, AnUndeclaredColumnIsAnInternalError) {
  Toy toy;
  const Toy::Result result = toy.run("--out toy.csv --set odd_row=undeclared");
  EXPECT_EQ(result.code, 1);
  EXPECT_THAT(result.err, HasSubstr("'sqare'"));
  EXPECT_FALSE(toy.exists("toy.csv"));
}

TEST(Sweep, ABrokenCheckMakesTheExitCodeThreeButKeepsTheTable) {
  Toy toy;
  const Toy::Result result = toy.run("--out toy.csv --set promise=broken");
  EXPECT_EQ(result.code, 3);
  EXPECT_THAT(result.err, HasSubstr("FAIL the promise (4)"));
  EXPECT_EQ(table(toy, "toy.csv").rows.size(), 4u);
}

struct Promise {
  std::string set;
  int code;
  std::string told, kept;  // in the message and in the manifest
};
void PrintTo(const Promise& promise, std::ostream* out) { *out << promise.set; }

class PromiseTest : public testing::TestWithParam<Promise> {};

// What changed is an alarm; what is known, was not run or depends on the machine is none.
TEST_P(PromiseTest, IsToldAndKeptInTheManifest) {
  const Promise& promise = GetParam();
  Toy toy;
  const Toy::Result result = toy.run("--out toy.csv --set promise=" + promise.set);
  EXPECT_EQ(result.code, promise.code) << result.err;
  EXPECT_THAT(result.err, HasSubstr(promise.told));
  EXPECT_THAT(toy.read("toy.meta.json"), HasSubstr(promise.kept));
  // Pages find it by its key, whatever its state and its words.
  EXPECT_THAT(toy.read("toy.meta.json"), HasSubstr("\"key\": \"key_of_the_promise\""));
}

INSTANTIATE_TEST_SUITE_P(
    Sweep, PromiseTest,
    testing::Values(
        Promise{"known", 0, "KNOWN LIMIT the promise (4); as the toy is",
                "\"state\": \"finding\""},
        Promise{"changed", 3, "CHANGED the promise (4); known to fail",
                "\"state\": \"changed\""},
        Promise{"not_judged", 0, "rows were not run: 1", "\"state\": \"not_judged\""},
        Promise{"figure", 0, "FIGURE the promise (4)", "\"state\": \"figure\""}),
    [](const auto& tested) { return tested.param.set; });

TEST(Sweep, KilledHalfWayResumesWithoutRepeatingFinishedRows) {
  Toy toy;
  const std::string command = "--out toy.csv --set particles=8 --set nap=0.05";
  const pid_t process = toy.start(command);
  toy.await_executions(4);  // so at least three rows are finished
  kill(process, SIGKILL);
  EXPECT_EQ(toy.wait(process).code, 128 + SIGKILL);
  EXPECT_FALSE(toy.exists("toy.csv"));
  const std::string journal = toy.read("toy.csv.journal");
  const auto finished = std::count(journal.begin(), journal.end(), '\n') - 1;
  ASSERT_GE(finished, 3);
  EXPECT_EQ(toy.run(command).code, 2)
      << "without --resume the finished rows would be lost";

  const std::size_t before = toy.executed().size();
  EXPECT_EQ(toy.run(command + " --resume").code, 0);
  EXPECT_EQ(toy.executed().size() - before, 8u - static_cast<std::size_t>(finished));
  EXPECT_THAT(cells(table(toy, "toy.csv"), "square"),
              ElementsAre("0", "1", "4", "9", "16", "25", "36", "49"));
  EXPECT_FALSE(toy.exists("toy.csv.journal"));
}

TEST(Sweep, ATornLastLineOfTheJournalIsRepeated) {
  Toy toy;
  const std::string command = "--out toy.csv --set particles=8 --set nap=0.05";
  const pid_t process = toy.start(command);
  toy.await_executions(4);
  kill(process, SIGKILL);
  static_cast<void>(toy.wait(process));
  const std::string journal = toy.read("toy.csv.journal");
  toy.write("toy.csv.journal", journal.substr(0, journal.size() - 9));
  const auto whole = std::count(journal.begin(), journal.end(), '\n') - 2;
  const std::size_t before = toy.executed().size();
  EXPECT_EQ(toy.run(command + " --resume").code, 0);
  EXPECT_EQ(toy.executed().size() - before, 8u - static_cast<std::size_t>(whole));
  EXPECT_EQ(table(toy, "toy.csv").rows.size(), 8u);
}

TEST(Sweep, ADamagedJournalAndOtherSettingsAreRefused) {
  Toy toy;
  const pid_t process = toy.start("--out toy.csv --set nap=0.2");
  toy.await_executions(3);
  kill(process, SIGKILL);
  static_cast<void>(toy.wait(process));
  const Toy::Result other = toy.run("--out toy.csv --set nap=0.1 --resume");
  EXPECT_EQ(other.code, 2);
  EXPECT_THAT(other.err, HasSubstr("other settings ('seed="));
  const std::string journal = toy.read("toy.csv.journal");
  const std::size_t second = journal.find('\n') + 1;
  toy.write("toy.csv.journal", std::string(journal).replace(second, 5, "x\nyz\n"));
  const Toy::Result damaged = toy.run("--out toy.csv --set nap=0.2 --resume");
  EXPECT_EQ(damaged.code, 2);
  EXPECT_THAT(damaged.err, HasSubstr("toy.csv.journal:2:1"));
}

/// A run that was interrupted after some rows, whose journal is then changed.
std::string message_after(const std::function<std::string(std::string)>& change) {
  Toy toy;
  const std::string command = "--out toy.csv --set particles=8 --set nap=0.05";
  const pid_t process = toy.start(command);
  toy.await_executions(4);
  kill(process, SIGKILL);
  static_cast<void>(toy.wait(process));
  toy.write("toy.csv.journal", change(toy.read("toy.csv.journal")));
  const Toy::Result run = toy.run(command + " --resume");
  EXPECT_EQ(run.code, 2);
  EXPECT_FALSE(toy.exists("toy.csv"));
  return run.err;
}

TEST(Sweep, AJournalInWhichOneDigitHasChangedIsRefused) {
  // The third row's square, 4: still a row, with another value.
  const std::string error = message_after([](std::string journal) {
    const std::string cell = R"(["square","4"])";
    return journal.replace(journal.find(cell), cell.size(), R"(["square","5"])");
  });
  EXPECT_THAT(error, HasSubstr("toy.csv.journal:4:1"));
  EXPECT_THAT(error, HasSubstr("checksum"));
}

TEST(Sweep, AJournalOfAnotherBuildIsRefused) {
  for (const std::string part : {"commit", "version", "build", "executable"}) {
    const std::string error = message_after([&](const std::string& journal) {
      const std::size_t end = journal.find('\n');
      std::string key(unsealed(journal.substr(0, end)));
      key.insert(key.find('"' + part + '"') + part.size() + 4, "0");
      return sealed(key) + journal.substr(end);
    });
    EXPECT_THAT(error, HasSubstr("it had another " + part)) << error;
  }
}

TEST(Sweep, InterruptKeepsTheJournalAndTellsHowToGoOn) {
  Toy toy;
  const std::string command = "--out toy.csv --set particles=8 --set nap=0.1";
  const pid_t process = toy.start(command);
  toy.await_executions(3);
  kill(process, SIGINT);
  const Toy::Result result = toy.wait(process);
  EXPECT_EQ(result.code, 130);
  EXPECT_THAT(result.err, HasSubstr("--resume"));
  EXPECT_THAT(toy.files(), ElementsAre("toy.csv.journal"));
  EXPECT_EQ(toy.run(command + " --resume").code, 0);
  EXPECT_EQ(table(toy, "toy.csv").rows.size(), 8u);
}

TEST(Sweep, ResumeOfACompleteTableRunsNothingAndRetryOnlyWhatFailed) {
  Toy toy;
  const std::string command = "--out toy.csv --set odd_row=quit";
  EXPECT_EQ(toy.run(command).code, 3);
  EXPECT_EQ(toy.run(command + " --resume").code, 3);
  EXPECT_EQ(toy.executed().size(), 4u);
  EXPECT_EQ(toy.run(command + " --resume --retry-failed").code, 3);
  EXPECT_THAT(toy.executed(), ElementsAre(0, 1, 2, 3, 2));
}

TEST(Sweep, ATableOfAnotherBuildIsMadeAgain) {
  Toy toy;
  ASSERT_EQ(toy.run("--out toy.csv").code, 0);
  std::string meta = toy.read("toy.meta.json");
  const std::string key = "\"executable_fnv1a_64\": \"";
  const std::size_t at = meta.find(key);
  ASSERT_NE(at, std::string::npos);
  toy.write("toy.meta.json", meta.replace(at + key.size(), 4, "0000"));
  const Toy::Result result = toy.run("--out toy.csv --resume");
  EXPECT_EQ(result.code, 0);
  EXPECT_THAT(result.err, HasSubstr("toy.csv was made by another build"));
  EXPECT_THAT(toy.executed(), ElementsAre(0, 1, 2, 3, 0, 1, 2, 3));
}

TEST(Sweep, ASecondRunOnTheSameTableIsRefusedWhileTheFirstRuns) {
  Toy toy;
  const pid_t process = toy.start("--out toy.csv --set nap=0.3");
  toy.await_executions(1);
  Toy other;
  const Toy::Result second =
      other.run("--resume --set nap=0.3 --out '" + toy.path("work") + "/toy.csv'");
  EXPECT_EQ(second.code, 2);
  EXPECT_THAT(second.err, HasSubstr("another run"));
  EXPECT_EQ(toy.wait(process).code, 0);
}

TEST(Sweep, AFullDiskDuringTheRunIsOneLineAndKeepsTheJournal) {
  Toy toy;
  // Two blocks hold the journal's first line and a few rows of the 30.
  const Toy::Result result =
      toy.run("--out toy.csv --progress none --set particles=30", "ulimit -f 2; ");
  EXPECT_EQ(result.code, 2);
  EXPECT_THAT(result.err, HasSubstr("toy: error: cannot write"));
  EXPECT_THAT(result.err, HasSubstr("free space"));
  EXPECT_THAT(toy.files(), ElementsAre("toy.csv.journal"));
  EXPECT_EQ(toy.run("--out toy.csv --set particles=30 --resume").code, 0);
  EXPECT_EQ(table(toy, "toy.csv").rows.size(), 30u);
}

/// A table without its timings.
std::vector<std::string> lasting(const CsvTable& of) {
  std::vector<std::string> lines;
  for (Row row : of.rows)
    lines.push_back(csv_line(in_order(row.set("wall_s", ""), of.header)));
  return lines;
}

TEST(Sweep, ShardsMergeIntoTheWholeTable) {
  Toy toy;
  const std::string same = " --set particles=7";
  EXPECT_EQ(toy.run("--out whole.csv" + same).code, 0);
  for (const std::string i : {"1", "2", "3"}) {
    EXPECT_EQ(toy.run("--shard " + i + "/3 --out part.csv" + same).code, 0);
  }
  EXPECT_EQ(toy.run("--merge part.3-of-3.csv part.1-of-3.csv part.2-of-3.csv --out "
                    "merged.csv" +
                    same)
                .code,
            0);
  EXPECT_EQ(lasting(table(toy, "merged.csv")), lasting(table(toy, "whole.csv")));
  EXPECT_EQ(table(toy, "merged.csv").rows.size(), 7u);
  const auto meta = nlohmann::json::parse(toy.read("whole.meta.json"));
  EXPECT_GT(meta.at("spent").at("processor_s").get<double>(), 0);
  EXPECT_GT(meta.at("spent").at("largest_mb").get<double>(), 1);
}

TEST(Sweep, MergeRefusesPartsThatDoNotBelongTogether) {
  Toy toy;
  for (const std::string i : {"1", "2", "3"}) {
    ASSERT_EQ(toy.run("--shard " + i + "/3 --out part.csv").code, 0);
  }
  ASSERT_EQ(toy.run("--shard 1/2 --out part.csv").code, 0);
  ASSERT_EQ(toy.run("--out whole.csv").code, 0);
  const std::string all = "part.1-of-3.csv part.2-of-3.csv part.3-of-3.csv";
  const auto refused = [&](const std::string& tables, const std::string& why) {
    const Toy::Result result = toy.run("--merge " + tables + " --out merged.csv");
    EXPECT_EQ(result.code, 2) << why;
    EXPECT_THAT(result.err, HasSubstr(why));
    EXPECT_EQ(result.error_lines(), 1);
    EXPECT_FALSE(toy.exists("merged.csv"));
  };
  refused("part.1-of-3.csv part.3-of-3.csv", "part 2/3 is missing");
  refused("part.1-of-3.csv part.2-of-3.csv", "part 3/3 is missing");
  refused(all + " part.2-of-3.csv", "part 2 is given twice");
  refused(all + " whole.csv", "some tables are parts of a sweep");
  refused("part.1-of-2.csv part.2-of-3.csv", "part 2/3 cannot be merged with part 1/2");
  refused(all + " --seed 4", "made with the options");
  std::string meta = toy.read("part.2-of-3.meta.json");
  const std::size_t commit = meta.find("\"commit\": \"");
  ASSERT_NE(commit, std::string::npos);
  toy.write("part.2-of-3.meta.json", meta.insert(commit + 11, "other"));
  refused(all, "made by commit other");
  toy.write("part.2-of-3.meta.json", "{}");
  refused(all, "not a manifest");
}

TEST(Sweep, MergeDropsRepeatsAndReportsContradictions) {
  Toy toy;
  ASSERT_EQ(toy.run("--out a.csv").code, 0);
  EXPECT_EQ(toy.run("--merge a.csv a.csv --out same.csv").code, 0);
  EXPECT_EQ(table(toy, "same.csv").rows.size(), 4u);
  std::string other = toy.read("a.csv");
  const std::size_t square = other.find("3,0.1,9,");
  ASSERT_NE(square, std::string::npos);
  toy.write("b.csv", other.replace(square, 8, "3,0.1,8,"));
  const Toy::Result result = toy.run("--merge a.csv b.csv --out c.csv");
  EXPECT_EQ(result.code, 3);
  EXPECT_THAT(result.err, HasSubstr("square is '9' and in b.csv '8'"));
  EXPECT_EQ(table(toy, "c.csv").rows.size(), 4u);
}

TEST(Sweep, StandardOutputGetsTheTableAndNothingElse) {
  Toy toy;
  const Toy::Result result = toy.run("--out -");
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(parse_csv(result.out, "out").rows.size(), 4u);
  EXPECT_TRUE(toy.files().empty());
}

TEST(Sweep, JsonProgressIsOneObjectPerRow) {
  Toy toy;
  const Toy::Result result = toy.run("--out toy.csv --progress json");
  const std::string first = result.err.substr(
      result.err.find('{'), result.err.find("}\n") + 1 - result.err.find('{'));
  EXPECT_EQ(nlohmann::json::parse(first).at("done"), 1);
  EXPECT_EQ(nlohmann::json::parse(first).at("total"), 4);
  EXPECT_THAT(result.err, Not(HasSubstr("\033")));
}

TEST(Sweep, DryRunPrintsTheRowsAndWritesNothing) {
  Toy toy;
  const Toy::Result result = toy.run("--dry-run --set particles=2");
  EXPECT_EQ(result.code, 0);
  EXPECT_THAT(result.out, HasSubstr("index=1 dt_s=0.1"));
  EXPECT_TRUE(toy.files().empty());
  EXPECT_TRUE(toy.executed().empty());
}

TEST(Sweep, HelpShowsTheExampleAndListTheKeys) {
  Toy toy;
  EXPECT_THAT(toy.run("--help").out, HasSubstr("toy --set particles=10 --out toy.csv"));
  EXPECT_THAT(toy.run("--version").out,
              StartsWith("toy " + std::string(build_facts().version) + " ("));
  const Toy::Result list = toy.run("--list");
  EXPECT_EQ(list.code, 0);
  EXPECT_THAT(list.out, HasSubstr("WHAT DRIVES WHAT"));
  EXPECT_THAT(list.out, HasSubstr("particles"));
  EXPECT_THAT(list.out, HasSubstr("rho_inf"));
}

TEST(Sweep, SceneFileSuppliesOptionsAndTheCommandLineWins) {
  Toy toy;
  toy.write("scene.toml",
            "title = \"two\"\nseed = 7\n[settings]\nparticles = 2\ndt = 0.25\n");
  ASSERT_EQ(toy.run("--options scene.toml --set dt=0.5 --out toy.csv").code, 0);
  const CsvTable rows = table(toy, "toy.csv");
  EXPECT_THAT(cells(rows, "dt_s"), ElementsAre("0.5", "0.5"));
  EXPECT_EQ(nlohmann::json::parse(toy.read("toy.meta.json")).at("seed"), 7);
}

}  // namespace tress::test_sweep
