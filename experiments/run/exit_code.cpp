#include "experiments/run/exit_code.h"

#include <signal.h>
#include <unistd.h>

#include <cstdio>
#include <exception>

#include "contract/input_error.h"
#include "experiments/run/command_line.h"
#include "experiments/run/message.h"
#include "simulation/files/parse.h"

namespace tress::experiments {
namespace {

/// One line; a long message (a key of a megabyte, say) is shortened to its beginning and
/// its end, which holds location and remedy.
std::string readable(std::string_view message) {
  constexpr std::size_t part = 2000;
  std::string line = one_line(message);
  if (line.size() > 2 * part) line.replace(part, line.size() - 2 * part, " ... ");
  return line;
}

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
    tell("{}: error: {}\n", program, readable(error.what()));
    return usage_error;
  } catch (const std::exception& error) {
    tell("{}: internal error: {}\n", program, readable(error.what()));
    return internal_error;
  }
}

}  // namespace tress::experiments
