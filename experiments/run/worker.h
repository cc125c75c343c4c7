#pragma once

#include <sys/types.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "experiments/run/experiment.h"

namespace tress::experiments {

/// One case in a forked process with its own process group, which dies with its parent.
/// Its row (or rows, from Case::run_rows) comes back through a pipe; its output goes to
/// standard error.
class Worker {
 public:
  using Clock = std::chrono::steady_clock;

  Worker(const Case& work, double timeout_s);
  ~Worker();  // kills a running process
  Worker(Worker&& other) noexcept;
  Worker& operator=(Worker&&) = delete;

  const Case& work() const { return *work_; }
  double seconds() const;             // since the start
  int pipe() const { return pipe_; }  // -1 once the far end is closed
  Clock::time_point killed_at() const { return kill_at_; }

  /// Reads what is available. Returns rows once the process has ended or timed out: its
  /// own, or the identity with status timeout or crashed.
  std::optional<std::vector<Row>> poll();

 private:
  void drain();
  std::vector<Row> result(int wait_status, bool timed_out) const;

  const Case* work_;
  double timeout_s_;
  Clock::time_point begun_, kill_at_;
  pid_t process_ = -1;
  int pipe_ = -1;
  std::string received_;
};

}  // namespace tress::experiments
