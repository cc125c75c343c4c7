#include "experiments/run/sweep.h"

#include <poll.h>
#include <signal.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "experiments/run/exit_code.h"
#include "experiments/run/worker.h"

namespace tress::experiments {
namespace {

constexpr int longest_wait_ms = 200;
/// A process whose pipe is closed ends within microseconds; poll again soon.
constexpr int ending_wait_ms = 1;

/// Converts stop_signals() to an event that poll() sees, during its lifetime.
class Interrupts {
 public:
  Interrupts() {
    const sigset_t set = stop_signals();
    sigprocmask(SIG_BLOCK, &set, &before_);
    descriptor_ = signalfd(-1, &set, SFD_CLOEXEC | SFD_NONBLOCK);
    if (descriptor_ < 0) {
      throw std::runtime_error(std::string("signalfd: ") + std::strerror(errno));
    }
  }
  ~Interrupts() {
    ::close(descriptor_);
    sigprocmask(SIG_SETMASK, &before_, nullptr);
  }
  Interrupts(const Interrupts&) = delete;
  Interrupts& operator=(const Interrupts&) = delete;

  int descriptor() const { return descriptor_; }
  bool happened() const {
    signalfd_siginfo info;
    return ::read(descriptor_, &info, sizeof info) == sizeof info;
  }

 private:
  sigset_t before_;
  int descriptor_;
};

void wait_for_news(const std::vector<Worker>& workers, int interrupts) {
  std::vector<pollfd> watched{{interrupts, POLLIN, 0}};
  auto wait = std::chrono::milliseconds(longest_wait_ms);
  const auto now = Worker::Clock::now();
  for (const Worker& worker : workers) {
    if (worker.pipe() < 0) wait = std::chrono::milliseconds(ending_wait_ms);
    watched.push_back({worker.pipe(), POLLIN, 0});
    const auto left =
        std::chrono::ceil<std::chrono::milliseconds>(worker.killed_at() - now);
    wait = std::clamp(left, std::chrono::milliseconds(0), wait);
  }
  ::poll(watched.data(), watched.size(), static_cast<int>(wait.count()));
}

}  // namespace

SweepEnd sweep(const std::vector<Case>& cases, int jobs, double timeout_s,
               const std::function<void(std::vector<Row>, double seconds)>& finished,
               const std::function<void(const Case&, double seconds)>& running) {
  const Interrupts interrupts;
  std::vector<Worker> workers;
  std::size_t next = 0;
  while (next < cases.size() || !workers.empty()) {
    while (next < cases.size() && workers.size() < static_cast<std::size_t>(jobs)) {
      workers.emplace_back(cases[next], timeout_s);
      ++next;
    }
    wait_for_news(workers, interrupts.descriptor());
    if (interrupts.happened()) return SweepEnd::interrupted;
    std::vector<Worker> left;
    for (Worker& worker : workers) {
      if (std::optional<std::vector<Row>> rows = worker.poll()) {
        finished(std::move(*rows), worker.seconds());
      } else {
        left.push_back(std::move(worker));
      }
    }
    workers.swap(left);
    if (!workers.empty()) running(workers.front().work(), workers.front().seconds());
  }
  return SweepEnd::complete;
}

}  // namespace tress::experiments
