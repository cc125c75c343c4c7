#include "experiments/run/worker.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <exception>
#include <new>
#include <stdexcept>
#include <utility>

#include "experiments/run/exit_code.h"
#include "experiments/run/journal.h"
#include "simulation/files/files.h"

namespace tress::experiments {
namespace {

/// Time between the deadline that a case may honour and the kill: a tenth of the timeout,
/// at least 50 ms, at most 2 s.
double grace_s(double timeout_s) { return std::clamp(0.1 * timeout_s, 0.05, 2.0); }

void reset_signals() {
  const sigset_t stops = stop_signals();
  for (const int stop : {SIGINT, SIGTERM, SIGHUP}) {
    if (sigismember(&stops, stop) != 0) ::signal(stop, SIG_DFL);
  }
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
}

/// The measured rows, or the partial rows if the case throws.
std::vector<Row> measured(const Case& work, const Deadline& deadline) {
  Row row = work.identity;
  try {
    if (!work.run_rows) {
      work.run(row, deadline);
      return {row};
    }
    std::vector<Row> rows = work.run_rows(row, deadline);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const std::string_view id = work.identity.text("run_id");
      rows[i].set("run_id", i == 0 ? std::string(id) : fmt::format("{}.{:03}", id, i));
    }
    if (rows.empty()) throw std::logic_error("a case without rows");
    return rows;
  } catch (const std::bad_alloc&) {
    row.failed("exception", "not enough memory");
  } catch (const std::exception& error) {
    row.failed("exception", error.what());
  } catch (...) {
    row.failed("exception", "something that is no std::exception was thrown");
  }
  return {row};
}

[[noreturn]] void run_case(const Case& work, double timeout_s, int pipe, pid_t parent) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);  // the parent died before the line above
  reset_signals();
  dup2(STDERR_FILENO, STDOUT_FILENO);
  try {
    std::string lines;
    for (const Row& row : measured(work, Deadline(timeout_s))) {
      lines += to_json_line(row) + '\n';
    }
    write_all(pipe, lines, "pipe");
  } catch (...) {
    _exit(1);
  }
  _exit(0);
}

}  // namespace

Worker::Worker(const Case& work, double timeout_s)
    : work_(&work),
      timeout_s_(timeout_s),
      begun_(Clock::now()),
      kill_at_(begun_ +
               std::chrono::duration_cast<Clock::duration>(
                   std::chrono::duration<double>(timeout_s + grace_s(timeout_s)))) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) {
    throw std::runtime_error(std::string("pipe: ") + std::strerror(errno));
  }
  const pid_t parent = getpid();
  process_ = fork();
  if (process_ < 0) {
    const int error = errno;
    ::close(ends[0]);
    ::close(ends[1]);
    throw std::runtime_error(std::string("fork: ") + std::strerror(error));
  }
  if (process_ == 0) run_case(work, timeout_s, ends[1], parent);
  setpgid(process_, process_);  // also here: the kill below must not come too early
  ::close(ends[1]);
  pipe_ = ends[0];
  fcntl(pipe_, F_SETFL, O_NONBLOCK);
}

Worker::Worker(Worker&& other) noexcept
    : work_(other.work_),
      timeout_s_(other.timeout_s_),
      begun_(other.begun_),
      kill_at_(other.kill_at_),
      process_(std::exchange(other.process_, -1)),
      pipe_(std::exchange(other.pipe_, -1)),
      received_(std::move(other.received_)) {}

Worker::~Worker() {
  if (process_ > 0) {
    kill(-process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }
  if (pipe_ >= 0) ::close(pipe_);
}

double Worker::seconds() const {
  return std::chrono::duration<double>(Clock::now() - begun_).count();
}

void Worker::drain() {
  char buffer[16384];
  while (pipe_ >= 0) {
    const ssize_t n = ::read(pipe_, buffer, sizeof buffer);
    if (n > 0) {
      received_.append(buffer, static_cast<std::size_t>(n));
    } else if (n < 0 && errno == EINTR) {
      continue;
    } else if (n < 0 && errno == EAGAIN) {
      return;
    } else {
      ::close(std::exchange(pipe_, -1));
    }
  }
}

std::optional<std::vector<Row>> Worker::poll() {
  drain();
  int wait_status = 0;
  const bool timed_out = Clock::now() >= kill_at_;
  if (timed_out) kill(-process_, SIGKILL);
  const pid_t ended = waitpid(process_, &wait_status, timed_out ? 0 : WNOHANG);
  if (ended == 0 || (ended < 0 && errno == EINTR)) return std::nullopt;
  kill(-process_, SIGKILL);  // including children it may have left behind
  process_ = -1;
  drain();
  return result(wait_status, timed_out);
}

std::vector<Row> Worker::result(int wait_status, bool timed_out) const {
  if (received_.ends_with('\n')) {
    try {
      std::vector<Row> rows;
      for (std::size_t at = 0; at < received_.size();) {
        const std::size_t end = received_.find('\n', at);
        rows.push_back(from_json_line(std::string_view(received_).substr(at, end - at)));
        at = end + 1;
      }
      return rows;
    } catch (const std::exception&) {
      // Malformed output: reported below as a crash.
    }
  }
  Row row = work_->identity;
  if (timed_out) {
    row.failed("timeout", fmt::format("killed after {:.3g} s", timeout_s_));
  } else if (WIFSIGNALED(wait_status)) {
    const int signal = WTERMSIG(wait_status);
    row.failed("crashed", fmt::format("signal {}: {}", signal, strsignal(signal)));
  } else {
    row.failed("crashed", fmt::format("exit code {} before the row was complete",
                                      WEXITSTATUS(wait_status)));
  }
  return {row};
}

}  // namespace tress::experiments
