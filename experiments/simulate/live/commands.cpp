// Commands of a live run on standard input, answers on standard output.
#include <unistd.h>

#include <iostream>
#include <string>

#include "contract/input_error.h"
#include "experiments/run/exit_code.h"
#include "experiments/simulate/live/live_run.h"
#include "simulation/files/files.h"

namespace tress::experiments::scene_runs {
namespace {

using nlohmann::json;

void answer(const json& line) {
  write_all(STDOUT_FILENO,
            line.dump(-1, ' ', false, json::error_handler_t::replace) + '\n',
            "standard output");
}

json answer_to(LiveRun& run, const std::string& line) {
  try {
    const json command = json::parse(line, nullptr, false);
    if (!command.is_object()) {
      throw InputError("the command is no JSON object", "live command",
                       "give {\"do\": \"step\"}");
    }
    run.execute(command);
    json frame = run.frame();
    if (command.value("do", "") == "set") frame["keys"] = run.keys();
    return frame;
  } catch (const json::exception&) {
    return {{"refused",
             "a value of the command has another type (live command): give "
             "numbers as numbers, names as texts"}};
  } catch (const InputError& error) {
    return {{"refused", error.what()}};
  }
}

}  // namespace

int run_live(const std::string& file, int threads, bool guard) {
  LiveRun run(file, threads, guard);
  json first = run.frame();
  first["keys"] = run.keys();
  first["stiffness_n_m"] = run.usual_stiffness();
  answer(first);
  for (std::string line; std::getline(std::cin, line);) answer(answer_to(run, line));
  return done;
}

}  // namespace tress::experiments::scene_runs
