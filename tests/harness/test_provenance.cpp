// What a manifest says of the program that wrote it, and how a program ends.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <new>
#include <nlohmann/json.hpp>

#include "contract/input_error.h"
#include "contract/read_file.h"
#include "contract/shipped_file.h"
#include "experiments/run/exit_code.h"
#include "experiments/run/message.h"
#include "experiments/run/row_loads.h"
#include "math/instructions.h"
#include "simulation/files/build_facts.h"
#include "simulation/files/checksum.h"
#include "simulation/files/files.h"
#include "tests/harness/toy_process.h"

namespace tress::test_provenance {

using namespace experiments;
namespace fs = std::filesystem;

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr const char* commit = "0123456789012345678901234567890123456789";

/// A git that answers another commit, or never: what a program must not ask.
std::string with_git(Toy& toy, const std::string& body) {
  fs::create_directory(toy.path("work") + "/bin");
  toy.write("bin/git", "#!/bin/sh\n" + body + "\n");
  fs::permissions(toy.path("work") + "/bin/git", fs::perms::owner_all);
  return "PATH='" + toy.path("work") + "/bin':\"$PATH\"; export PATH; ";
}

TEST(Provenance, IsThatOfTheBuildWhateverGitWouldSay) {
  Toy toy;
  const std::string prefix =
      with_git(toy, "touch '" + toy.path("asked") + "'\necho 1111\nsleep 1000");
  ASSERT_EQ(toy.run("--out toy.csv", prefix).code, 0);
  EXPECT_FALSE(fs::exists(toy.path("asked")));
  const auto meta = nlohmann::json::parse(toy.read("toy.meta.json"));
  const auto built = meta.at("git").at("commit").get<std::string>();
  EXPECT_EQ(built, build_facts().commit);
  const std::string version = toy.run("--version").out;
  EXPECT_THAT(version, HasSubstr("(" + built + ")"));
  EXPECT_THAT(version, HasSubstr(std::string(build_facts().flags)));
  EXPECT_THAT(version, HasSubstr(name(widest_instructions())));
  EXPECT_EQ(meta.at("build").at("executable_fnv1a_64"),
            checksum(read_file(TOY_EXPERIMENT)));
}

TEST(Provenance, ABuildTreeIsNotAnInstalledOne) {
  EXPECT_EQ(installed_root(), "");
  for (const char* file : {"", "none.toml", "/proc/self/exe", "."}) {
    EXPECT_EQ(shipped_file(file), file);
  }
}

TEST(Provenance, TheCommitOfATreeIsReadWithoutGit) {
  Toy toy;
  const std::string tree = toy.path("work");
  EXPECT_EQ(checked_out(tree), "");
  fs::create_directories(tree + "/.git/refs/heads");
  toy.write(".git/HEAD", std::string(commit) + "\n");
  EXPECT_EQ(checked_out(tree), commit);
  toy.write(".git/HEAD", "ref: refs/heads/main\n");
  EXPECT_EQ(checked_out(tree), "");
  toy.write(".git/packed-refs",
            fmt::format("# pack-refs with: peeled\n{} refs/heads/main\n"
                        "ffff refs/heads/main2\n",
                        commit));
  EXPECT_EQ(checked_out(tree), commit);
  toy.write(".git/refs/heads/main", "abcd\n");
  EXPECT_EQ(checked_out(tree), "abcd");
  // A further work tree.
  fs::create_directories(tree + "/.git/worktrees/two");
  fs::create_directories(tree + "/two");
  toy.write(".git/worktrees/two/HEAD", "ref: refs/heads/main\n");
  toy.write(".git/worktrees/two/commondir", "../..\n");
  toy.write("two/.git", "gitdir: ../.git/worktrees/two\n");
  EXPECT_EQ(checked_out(tree + "/two"), "abcd");
}

TEST(ExitCode, OfTooLittleMemoryIsThatOfInput) {
  testing::internal::CaptureStderr();
  const int code = exit_code("toy", []() -> int { throw std::bad_alloc(); });
  const std::string text = testing::internal::GetCapturedStderr();
  EXPECT_EQ(code, usage_error);
  EXPECT_THAT(text, testing::StartsWith("toy: error: not enough memory: "));
}

/// A child that was not waited for is another program: alone on the machine it uses a
/// processor; on one that is full, all others together use all.
TEST(Load, IsWhatOtherProgramsUse) {
  OtherLoad others;
  const pid_t child = fork();
  if (child == 0) {
    while (true) getpid();
  }
  while (others.seconds() < 0.5) usleep(10'000);
  EXPECT_GT(others.processors(), most_load);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
}

TEST(Load, OfOthersMarksTheRowsThatRanBesideThem) {
  RowLoads loads;
  const pid_t child = fork();
  if (child == 0) {
    while (true) getpid();
  }
  usleep(600'000);
  EXPECT_GT(loads.finished("slow"), most_load);
  EXPECT_GT(loads.finished("short"), most_load);  // as the last measurement
  EXPECT_THAT(loads.above(), testing::Contains("slow"));
  EXPECT_GT(loads.largest(), most_load);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
}

TEST(Signals, OfATerminalThatCloses) {
  const auto is_a_stop = [] {
    const sigset_t set = stop_signals();
    return sigismember(&set, SIGHUP) == 1;
  };
  EXPECT_TRUE(is_a_stop());
  const auto before = signal(SIGHUP, SIG_IGN);  // as nohup does
  EXPECT_FALSE(is_a_stop());
  signal(SIGHUP, before);
}

/// SIGPIPE has its usual effect: to end the program.
TEST(Signals, NobodyNeedListenToMessages) {
  EXPECT_EXIT(
      {
        signal(SIGPIPE, SIG_DFL);
        int ends[2];
        if (pipe(ends) != 0 || dup2(ends[1], STDERR_FILENO) < 0) _exit(1);
        close(ends[0]);
        close(ends[1]);
        tell("a message that nobody reads\n");
        sigset_t waiting;
        sigpending(&waiting);
        _exit(sigismember(&waiting, SIGPIPE) == 0 ? 0 : 2);
      },
      testing::ExitedWithCode(0), "");
}

TEST(Sweep, AHangUpKeepsTheJournal) {
  Toy toy;
  const std::string command = "--out toy.csv --set particles=8 --set nap=0.1";
  const pid_t process = toy.start(command);
  toy.await_executions(3);
  kill(process, SIGHUP);
  EXPECT_EQ(toy.wait(process).code, 130);
  EXPECT_THAT(toy.files(), ElementsAre("toy.csv.journal"));
  EXPECT_EQ(toy.run(command + " --resume").code, 0);
}

TEST(Sweep, ARowThatTakesLongIsToldOf) {
  Toy toy;
  const Toy::Result result = toy.run("--out toy.csv --set particles=1 --set nap=5.5");
  EXPECT_EQ(result.code, 0);
  EXPECT_THAT(result.err, HasSubstr("toy: 0/1 rows, 0 failed; for 5 s at index=0"));
  const Toy::Result json =
      toy.run("--out toy.csv --set particles=1 --set nap=5.5 --progress json");
  const std::size_t begin = json.err.find('{');
  const auto first =
      nlohmann::json::parse(json.err.substr(begin, json.err.find('\n', begin) - begin));
  EXPECT_EQ(first.at("event"), "running");
}

TEST(Sweep, WhatAKilledRunLeftIsRemoved) {
  Toy toy;
  // Above the largest number of a process: it is gone for certain.
  toy.write("toy.csv.tmp999999999", "");
  toy.write("toy.meta.json.tmp999999999", "");
  const std::string kept[] = {fmt::format("toy.csv.tmp{}", getpid()),
                              "toyish.csv.tmp999999999", "toy.csv.tmpx"};
  for (const std::string& name : kept) toy.write(name, "");
  ASSERT_EQ(toy.run("--out toy.csv").code, 0);
  EXPECT_THAT(toy.files(), testing::UnorderedElementsAre("toy.csv", "toy.meta.json",
                                                         kept[0], kept[1], kept[2]));
}

TEST(Check, RefusesWhatARunWouldRefuseAndRunsNothing) {
  Toy toy;
  EXPECT_EQ(toy.run("--out toy.csv --check").code, 0);
  EXPECT_TRUE(toy.files().empty());
  const pid_t process = toy.start("--out toy.csv --set particles=8 --set nap=0.1");
  toy.await_executions(3);  // so that the journal has a row
  kill(process, SIGTERM);
  toy.wait(process);
  const std::size_t executed = toy.executed().size();
  const std::string same = "--out toy.csv --set particles=8 --set nap=0.1 --check";
  const Toy::Result fresh = toy.run(same);
  EXPECT_EQ(fresh.code, 2);
  EXPECT_THAT(fresh.err, HasSubstr("an earlier run did not finish (toy.csv.journal)"));
  EXPECT_EQ(toy.run(same + " --resume").code, 0);
  EXPECT_EQ(toy.run("--out toy.csv --resume --check").code, 2);  // other settings
  EXPECT_EQ(toy.executed().size(), executed);
  EXPECT_THAT(toy.files(), ElementsAre("toy.csv.journal"));
}

TEST(Output, ThatCannotBeWrittenIsRefusedBeforeAnyWork) {
  Toy toy;
  fs::create_directory(toy.path("work") + "/taken.meta.json");
  toy.write("victim", "precious");
  fs::create_symlink("victim", toy.path("work") + "/link.csv");
  fs::create_symlink("nowhere", toy.path("work") + "/loose.csv");
  for (const auto& [options, message] :
       {std::pair{"--out taken.csv", "is a directory (--out taken.meta.json)"},
        std::pair{"--out link.csv", "is a link (--out link.csv)"},
        std::pair{"--out loose.csv", "is a link (--out loose.csv)"},
        std::pair{"--out none/x.csv --dry-run", "directory does not exist"}}) {
    const Toy::Result result = toy.run(options);
    EXPECT_EQ(result.code, 2) << options;
    EXPECT_EQ(result.error_lines(), 1) << result.err;
    EXPECT_THAT(result.err, HasSubstr(message));
  }
  EXPECT_TRUE(toy.executed().empty());
  EXPECT_EQ(toy.read("victim"), "precious");
}

TEST(Output, AFolderThatStaysEmptyIsRemovedAgain) {
  Toy toy;
  fs::create_directory(toy.path("work") + "/there");
  const std::string stays = toy.path("work") + "/there/a",
                    goes = toy.path("work") + "/b/c";
  {
    const ReadyFolder one(stays, "--out a"), other(goes, "--out b/c");
    EXPECT_TRUE(fs::is_directory(goes));
    toy.write("there/a/file", "");
  }
  EXPECT_THAT(toy.files(), ElementsAre("there", "there/a", "there/a/file"));
  toy.write("file", "");
  EXPECT_THROW(ReadyFolder(toy.path("work") + "/file/x", "--out x"), InputError);
}

TEST(Help, BeginsWithTheProgramAndShowsItsKeys) {
  Toy toy;
  const std::string help = toy.run("--help").out;
  EXPECT_THAT(help, testing::StartsWith("toy: Does the harness keep its promises?\n"
                                        "Usage: toy [OPTIONS]\n"));
  EXPECT_THAT(help, HasSubstr("particles            rows of the table [4]"));
  EXPECT_THAT(help, Not(HasSubstr("\n\n\n")));
}

}  // namespace tress::test_provenance
