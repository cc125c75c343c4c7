#include "experiments/run/advised.h"

#include <unistd.h>

#include <filesystem>

#include "experiments/run/message.h"
#include "simulation/files/files.h"

namespace tress::experiments {

void print_advice(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + '\n';
  write_all(STDOUT_FILENO, text, "standard output");
}

void print_answer(const CommandLine& line, std::vector<std::string> lines) {
  if (line.places.count("set:scenes") == 0 || line.out == "-") return;
  lines.push_back("table: " + line.out);
  print_advice(lines);
}

void write_advised(std::string_view experiment, const CommandLine& line,
                   const std::string& scene, const std::string& text) {
  const auto folder = std::filesystem::path(line.out).parent_path();
  const std::string to = (folder / (scene + ".advised.toml")).string();
  replace_file(to, text);
  tell("{}: wrote {}\n", experiment, to);
}

}  // namespace tress::experiments
