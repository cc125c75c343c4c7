#include "experiments/run/message.h"

#include <pthread.h>
#include <signal.h>

#include <cstdio>
#include <ctime>

namespace tress::experiments {

// SIGPIPE comes to the thread that writes: it is held back and taken, unless it was held
// back or waiting before.
void tell_text(const std::string& text) {
  sigset_t pipe, before, waiting;
  sigemptyset(&pipe);
  sigaddset(&pipe, SIGPIPE);
  sigpending(&waiting);
  pthread_sigmask(SIG_BLOCK, &pipe, &before);
  std::fputs(text.c_str(), stderr);
  if (sigismember(&waiting, SIGPIPE) == 0) {
    constexpr timespec at_once{};
    sigtimedwait(&pipe, nullptr, &at_once);
  }
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

}  // namespace tress::experiments
