#include "experiments/run/interruption.h"

#include <pthread.h>
#include <unistd.h>

#include <exception>

#include "experiments/run/exit_code.h"
#include "experiments/run/message.h"

namespace tress::experiments {
Interruption::Interruption(std::string_view program)
    : program_(program), signals_(stop_signals()) {
  pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
  thread_ = std::thread([this] { wait(); });
}

Interruption::~Interruption() {
  over_ = true;
  pthread_kill(thread_.native_handle(), SIGINT);
  thread_.join();
  pthread_sigmask(SIG_UNBLOCK, &signals_, nullptr);
}

void Interruption::wait() {
  int signal = 0;
  sigwait(&signals_, &signal);
  if (over_) return;
  // A second signal is not waited for: exit_code()'s handler ends the program.
  pthread_sigmask(SIG_UNBLOCK, &signals_, nullptr);
  const auto held = hold();
  if (silent_ && silent_()) ::_exit(interrupted);
  try {
    if (save_) save_();
    tell("{}{}: interrupted: the same command with --resume continues\n",
         ::isatty(STDERR_FILENO) != 0 ? "\r\033[K" : "", program_);
  } catch (const std::exception& error) {
    tell("{}: interrupted, and {}\n", program_, error.what());
  }
  ::_exit(interrupted);
}

}  // namespace tress::experiments
