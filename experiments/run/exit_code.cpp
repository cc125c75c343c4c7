#include "experiments/run/exit_code.h"

#include <signal.h>
#include <unistd.h>

#include <cstdio>
#include <exception>

#include "contract/input_error.h"
#include "experiments/run/command_line.h"
#include "experiments/run/message.h"

namespace tress::experiments {
namespace {

constexpr std::size_t longest_message = 4000;

}  // namespace

int exit_code(std::string_view program, const std::function<int()>& run) {
  ::signal(SIGXFSZ, SIG_IGN);
  for (const int stop : {SIGINT, SIGTERM}) {
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
  } catch (const std::exception& error) {
    tell("{}: internal error: {}\n", program, shortened(error.what(), longest_message));
    return internal_error;
  }
}

}  // namespace tress::experiments
