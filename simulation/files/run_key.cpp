#include "simulation/files/run_key.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "contract/input_error.h"
#include "simulation/files/build_facts.h"
#include "simulation/files/checksum.h"
#include "simulation/files/files.h"
#include "simulation/files/source_state.h"

namespace tress::simulation {
namespace {

using nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr std::size_t longest_shown = 160;  // characters of both values

bool is_file(const std::string& file) {
  std::error_code ignored;
  return fs::is_regular_file(file, ignored);
}

void add_file(const std::string& file, Checksum& sum) {
  // The separator marks the boundary between files.
  sum.add(is_file(file) ? read_file(file) : "").add("\x1f");
}

/// Texts between two quotes of the same kind on one line.
std::vector<std::string> quoted_texts(const std::string& text) {
  std::vector<std::string> found;
  for (std::size_t at = text.find_first_of("\"'"); at != std::string::npos;
       at = text.find_first_of("\"'", at + 1)) {
    const std::size_t end = text.find_first_of(std::string{text[at], '\n'}, at + 1);
    if (end == std::string::npos || text[end] == '\n') continue;
    found.push_back(text.substr(at + 1, end - at - 1));
    at = end;
  }
  return found;
}

}  // namespace

RunKey::RunKey() {
  const SourceState source = source_state();
  add("version", std::string(build_facts().version));
  add("commit", source.commit + (source.dirty ? " with changes" : ""));
}

RunKey& RunKey::add(std::string name, std::string value) {
  parts_.emplace_back(std::move(name), std::move(value));
  return *this;
}

std::string RunKey::line() const {
  ordered_json key = ordered_json::object();
  for (const auto& [name, value] : parts_) key[name] = value;
  return key.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

void RunKey::check(std::string_view found, const std::string& file) const {
  if (found == line()) return;
  std::string problem = "its first line is damaged";
  const ordered_json other = ordered_json::parse(found, nullptr, false);
  for (const auto& [name, value] : parts_) {
    if (!other.is_object() || !other.contains(name) || !other[name].is_string()) break;
    const auto was = other[name].get<std::string>();
    if (was == value) continue;
    problem = "it had other " + name;
    if (was.size() + value.size() <= longest_shown) {
      problem += fmt::format(" ('{}', now '{}')", was, value);
    }
    break;
  }
  throw InputError("the unfinished run cannot be continued: " + problem, file,
                   "repeat what it had, choose another --out, or delete that file");
}

std::string contents_checksum(const std::vector<std::string>& files) {
  Checksum sum;
  for (const std::string& file : files) {
    add_file(file, sum);
    if (!file.ends_with(".toml") || !is_file(file)) continue;
    const fs::path folder = fs::path(file).parent_path();
    for (const std::string& name : quoted_texts(read_file(file))) {
      const std::string named = (folder / name).string();
      if (is_file(named)) add_file(named, sum);
    }
  }
  return sum.text();
}

}  // namespace tress::simulation
