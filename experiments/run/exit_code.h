#pragma once

#include <functional>
#include <string_view>

#include "contract/layers.h"

namespace tress::experiments {

/// What every program of ours ends with.
enum ExitCode {
  done = 0,
  internal_error = 1,
  usage_error = 2,
  rows_failed = 3,
  interrupted = 130
};

/// The code of a whole main(): that of `run`, or where it throws, of what it throws, said
/// in one line on standard error. An Answer is printed and is `done`. A file size limit
/// becomes an error of write instead of a signal; SIGINT and SIGTERM end the program at
/// once with `interrupted` where nothing else answers them (Interruption, sweep).
int exit_code(std::string_view program, const std::function<int()>& run);

}  // namespace tress::experiments
