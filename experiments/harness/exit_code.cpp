#include "experiments/harness/exit_code.h"

#include <signal.h>
#include <unistd.h>

#include <cstdio>
#include <exception>

#include "experiments/harness/command_line.h"
#include "experiments/harness/message.h"
#include "experiments/harness/parse.h"
#include "models/input_error.h"

namespace tress {

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
    tell("{}: error: {}\n", program, one_line(error.what()));
    return usage_error;
  } catch (const std::exception& error) {
    tell("{}: internal error: {}\n", program, one_line(error.what()));
    return internal_error;
  }
}

}  // namespace tress
