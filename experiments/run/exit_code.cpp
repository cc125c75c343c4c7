#include "experiments/run/exit_code.h"

#include <unistd.h>

#include <cstdio>
#include <exception>
#include <new>

#include "contract/input_error.h"
#include "experiments/run/command_line.h"
#include "experiments/run/message.h"

namespace tress::experiments {
namespace {

constexpr int all_stops[] = {SIGINT, SIGTERM, SIGHUP};
constexpr std::size_t longest_message = 4000;

}  // namespace

int exit_code(std::string_view program, const std::function<int()>& run) {
  ::signal(SIGXFSZ, SIG_IGN);
  const sigset_t stops = stop_signals();
  for (const int stop : all_stops) {
    if (sigismember(&stops, stop) == 0) continue;
    ::signal(stop, [](int) { ::_exit(interrupted); });
  }
  try {
    return run();
  } catch (const Answer& text) {
    std::fputs(text.what(), stdout);
    return done;
  } catch (const InputError& error) {
    tell("{}: error: {}\n", program, error.what());
    return usage_error;
  } catch (const std::bad_alloc&) {
    tell(
        "{}: error: not enough memory: run a smaller scene or fewer rows at once "
        "(--jobs, "
        "--threads), or on a machine with more\n",
        program);
    return usage_error;
  } catch (const std::exception& error) {
    tell("{}: internal error: {}\n", program, shortened(error.what(), longest_message));
    return internal_error;
  }
}

sigset_t stop_signals() {
  sigset_t set;
  sigemptyset(&set);
  for (const int stop : all_stops) {
    struct sigaction now {};
    if (stop == SIGHUP && ::sigaction(stop, nullptr, &now) == 0 &&
        now.sa_handler == SIG_IGN) {
      continue;
    }
    sigaddset(&set, stop);
  }
  return set;
}

}  // namespace tress::experiments
