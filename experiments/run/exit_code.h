#pragma once

#include <signal.h>

#include <functional>
#include <string_view>

#include "contract/layers.h"

namespace tress::experiments {

/// Exit codes of all programs.
enum ExitCode {
  done = 0,
  internal_error = 1,
  usage_error = 2,
  rows_failed = 3,
  interrupted = 130
};

/// Exit code of a whole main(): the result of `run`, or the code of the exception it
/// throws, reported in one line on standard error. An Answer is printed and yields
/// `done`. Exceeding a file size limit is a write error, not a signal; stop_signals() end
/// the program at once with `interrupted` unless something else handles them
/// (Interruption, sweep).
int exit_code(std::string_view program, const std::function<int()>& run);

/// Signals that ask a program to end: SIGINT, SIGTERM and, unless the program was started
/// to outlive its terminal (nohup), SIGHUP.
sigset_t stop_signals();

}  // namespace tress::experiments
