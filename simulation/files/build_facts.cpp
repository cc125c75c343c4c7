#include "simulation/files/build_facts.h"

#include <filesystem>
#include <sstream>

#include "contract/input_error.h"
#include "contract/read_file.h"
#include "math/instructions.h"
#include "simulation/files/built_from.h"
#include "simulation/files/checksum.h"

namespace tress::simulation {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t most_git_bytes = 100'000'000;  // of packed references

/// The file's text without the last line's end; empty if it cannot be read.
std::string text_of(const fs::path& file) {
  try {
    std::string text = read_file(file.string(), most_git_bytes);
    while (text.ends_with('\n')) text.pop_back();
    return text;
  } catch (const InputError&) {
    return {};
  }
}

/// What follows `start` in a text that begins so.
std::string after(const std::string& start, const std::string& text) {
  return text.starts_with(start) ? text.substr(start.size()) : std::string();
}

}  // namespace

std::string BuildFacts::code() const {
  return std::string(commit) + (dirty() ? " with changes " + std::string(changes) : "");
}

std::string BuildFacts::described(std::string_view program) const {
  std::ostringstream text;
  text << program << ' ' << version << " (" << commit << ")\n";
  if (dirty()) text << "sources: changed since this commit (" << changes << ")\n";
  text << "build: " << type << ", " << compiler << ", flags " << flags << '\n'
       << "instructions: " << name(Instructions::base) << " from the compiler, "
       << name(widest_instructions()) << " in packs of strands on this processor\n";
  return text.str();
}

const BuildFacts& build_facts() {
  static constexpr BuildFacts facts{
      TRESS_VERSION,  TRESS_GIT_COMMIT, TRESS_GIT_CHANGES, TRESS_SOURCE_TREE,
      TRESS_COMPILER, TRESS_FLAGS,      TRESS_BUILD_TYPE};
  return facts;
}

const std::string& executable_checksum() {
  static const std::string sum = [] {
    // Not by its name: the file may have been replaced since.
    try {
      return checksum(read_file("/proc/self/exe"));
    } catch (const InputError&) {
      return std::string("unknown");
    }
  }();
  return sum;
}

std::string checked_out(std::string_view source_tree) {
  if (source_tree.empty()) return {};
  const fs::path tree(source_tree);
  fs::path folder = tree / ".git";
  // A further work tree of a repository has a file there.
  if (const std::string elsewhere = after("gitdir: ", text_of(folder));
      !elsewhere.empty()) {
    folder = tree / elsewhere;
  }
  const std::string head = text_of(folder / "HEAD");
  const std::string reference = after("ref: ", head);
  if (reference.empty()) return head;
  const std::string shared = text_of(folder / "commondir");
  const fs::path common = shared.empty() ? folder : folder / shared;
  if (std::string commit = text_of(common / reference); !commit.empty()) return commit;
  std::istringstream packed(text_of(common / "packed-refs"));
  for (std::string line; std::getline(packed, line);) {
    if (line.ends_with(' ' + reference)) return line.substr(0, line.find(' '));
  }
  return {};
}

}  // namespace tress::simulation
