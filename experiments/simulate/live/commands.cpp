// Commands of a live run on standard input, answers on standard output.
#include <unistd.h>

#include <cctype>
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

/// Replaces places in the file by the key that was set: the run reads the changed scene,
/// whose lines are others.
std::string at_key(std::string text, const std::string& file, const std::string& key) {
  for (std::size_t at = 0; (at = text.find(file + ":", at)) != std::string::npos;) {
    std::size_t end = at + file.size();
    while (end < text.size() && (text[end] == ':' || std::isdigit(text[end]) != 0)) ++end;
    text.replace(at, end - at, key);
    at += key.size();
  }
  return text;
}

json answer_to(LiveRun& run, const std::string& line) {
  const json command = json::parse(line, nullptr, false);
  try {
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
    const json key = command.is_object() ? command.value("key", json()) : json();
    return {{"refused", key.is_string()
                            ? at_key(error.what(), run.file(), key.get<std::string>())
                            : error.what()}};
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
