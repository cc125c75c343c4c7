#pragma once

#include <string>
#include <vector>

namespace tress::testing_support {

struct LimitedRun {
  int code = 0;          // its exit code, 128 more than a signal that ended it
  bool stopped = false;  // it was sent SIGINT
  bool hung = false;     // it did not end within a second of that, and was killed
};

/// Runs a program, its output in stem.out and stem.err, and stops it when it has used so
/// many seconds of processor time, or has run for ten times as long.
LimitedRun run_limited(std::vector<std::string> command, const std::string& stem,
                       double seconds);

}  // namespace tress::testing_support
