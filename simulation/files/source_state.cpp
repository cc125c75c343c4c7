#include "simulation/files/source_state.h"

#include <fmt/format.h>

#include <cstdio>
#include <string_view>

#include "simulation/files/build_facts.h"

namespace tress::simulation {
namespace {

struct Output {
  int status = -1;
  std::string text;
};

Output git(const std::string& arguments) {
  std::string tree;
  for (const char c : build_facts().source_tree) {
    tree += c == '\'' ? std::string("'\\''") : std::string(1, c);
  }
  const std::string command =
      fmt::format("git --no-optional-locks -C '{}' {} 2>/dev/null", tree, arguments);
  Output output;
  std::FILE* stream = ::popen(command.c_str(), "r");
  if (stream == nullptr) return output;
  char buffer[4096];
  while (const std::size_t n = std::fread(buffer, 1, sizeof buffer, stream)) {
    output.text.append(buffer, n);
  }
  output.status = ::pclose(stream);
  while (output.text.ends_with('\n')) output.text.pop_back();
  return output;
}

}  // namespace

SourceState source_state() {
  const Output commit = git("rev-parse HEAD");
  if (commit.status != 0)
    return {.commit = std::string(build_facts().commit), .dirty = false};
  const Output changes =
      git("status --porcelain --untracked-files=no -- . ':(exclude)results'");
  return {.commit = commit.text, .dirty = !changes.text.empty()};
}

}  // namespace tress::simulation
