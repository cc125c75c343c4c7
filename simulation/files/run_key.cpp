#include "simulation/files/run_key.h"

#include <fmt/format.h>

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>

#include "contract/input_error.h"
#include "simulation/files/build_facts.h"
#include "simulation/files/checksum.h"
#include "simulation/files/files.h"
#include "simulation/files/toml_text.h"

namespace tress::simulation {
namespace {

using nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr std::size_t longest_shown = 160;  // characters of both values

bool is_file(const std::string& file) {
  std::error_code ignored;
  return fs::is_regular_file(file, ignored);
}

/// Calls `use` with every text of a TOML value, escapes resolved.
void for_each_text(const toml::node& node,
                   const std::function<void(const std::string&)>& use) {
  if (const auto* text = node.as_string()) {
    use(text->get());
  } else if (const auto* table = node.as_table()) {
    for (const auto& [key, value] : *table) for_each_text(value, use);
  } else if (const auto* list = node.as_array()) {
    for (const toml::node& entry : *list) for_each_text(entry, use);
  }
}

/// The files that a scene names, in any way that TOML writes a text. Nothing for a file
/// that is no TOML; reading it reports the error.
std::vector<std::string> files_named(const std::string& text, const std::string& file) {
  std::vector<std::string> files;
  try {
    for_each_text(parse_toml(text, file), [&](const std::string& name) {
      if (name.find('\0') != std::string::npos) return;
      const std::string named = (fs::path(file).parent_path() / name).string();
      if (is_file(named)) files.push_back(named);
    });
  } catch (const InputError&) {
  }
  return files;
}

}  // namespace

RunKey::RunKey() {
  const BuildFacts& built = build_facts();
  add("version", std::string(built.version));
  add("commit", built.code());
  add("build", fmt::format("{}, {}, {}", built.type, built.compiler, built.flags));
  add("executable", executable_checksum());
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
    problem = "it had another " + name;
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
  const auto add = [&](const std::string& text) {
    sum.add(text).add("\x1f");  // marks the boundary between files
  };
  for (const std::string& file : files) {
    const std::string text = is_file(file) ? read_file(file) : "";
    add(text);
    if (text.size() > most_toml_bytes) continue;
    for (const std::string& named : files_named(text, file)) add(read_file(named));
  }
  return sum.text();
}

}  // namespace tress::simulation
