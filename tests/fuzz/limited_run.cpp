#include "tests/fuzz/limited_run.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <ctime>
#include <thread>

namespace tress::testing_support {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

constexpr double patience = 1;      // s from the signal to the end
constexpr double wall_factor = 10;  // of a run that waits instead of working

constexpr int no_program = 127;  // as a shell says it

/// The process; 0: none.
pid_t start(std::vector<std::string>& command, const std::string& stem) {
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  constexpr int flags = O_WRONLY | O_CREAT | O_TRUNC;
  posix_spawn_file_actions_addopen(&files, 1, (stem + ".out").c_str(), flags, 0644);
  posix_spawn_file_actions_addopen(&files, 2, (stem + ".err").c_str(), flags, 0644);
  std::vector<char*> arguments;
  arguments.reserve(command.size() + 1);
  for (std::string& argument : command) arguments.push_back(argument.data());
  arguments.push_back(nullptr);
  pid_t process = 0;
  const int error =
      posix_spawn(&process, arguments[0], &files, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  return error == 0 ? process : 0;
}

double processor_time(pid_t process) {
  clockid_t clock{};
  timespec used{};
  if (clock_getcpuclockid(process, &clock) != 0 || clock_gettime(clock, &used) != 0) {
    return 0;
  }
  return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
}

}  // namespace

LimitedRun run_limited(std::vector<std::string> command, const std::string& stem,
                       double seconds) {
  const pid_t process = start(command, stem);
  if (process == 0) return {.code = no_program};
  const auto begin = Clock::now();
  auto signalled = begin;
  LimitedRun run;
  int status = 0;
  while (waitpid(process, &status, WNOHANG) == 0) {
    const auto now = Clock::now();
    if (run.stopped) {
      if (!run.hung && Seconds(now - signalled).count() > patience) {
        run.hung = true;
        kill(process, SIGKILL);
      }
    } else if (processor_time(process) > seconds ||
               Seconds(now - begin).count() > wall_factor * seconds) {
      run.stopped = true;
      signalled = now;
      kill(process, SIGINT);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  run.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return run;
}

}  // namespace tress::testing_support
