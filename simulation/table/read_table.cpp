#include "simulation/table/read_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <vector>

#include "contract/input_error.h"
#include "simulation/table/rows_file.h"

namespace tress::simulation {
namespace {

std::string_view wanted(const Parameter& p) {
  if (p.text) return p.rows ? "a list of strings" : "a string";
  if (p.choices == "true|false") return "true or false";
  if (!p.choices.empty()) return "a string";
  if (p.rows) {
    return p.components > 1 ? "a list of lists of numbers, or a file of rows"
                            : "a list of numbers, or a file of rows";
  }
  return p.components > 1 ? "a list of numbers" : "a number";
}

std::string_view kind(const toml::node& node) {
  if (node.is_string()) return "a string";
  if (node.is_boolean()) return "true or false";
  if (node.is_number()) return "a number";
  if (node.is_array()) return "a list";
  if (node.is_table()) return "a table";
  return "a date or a time";
}

[[noreturn]] void wrong_type(const Parameter& p, const toml::node& node,
                             const std::string& file) {
  throw InputError(fmt::format("{}: expected {}, got {}", p.name, wanted(p), kind(node)),
                   place_of(node.source(), file),
                   fmt::format("give {}: {}", wanted(p), p.help));
}

std::string number_text(const Parameter& p, const toml::node& node,
                        const std::string& file) {
  if (!node.is_number()) wrong_type(p, node, file);
  return scalar_text(node);
}

/// Numbers of a list, joined by commas.
std::string tuple_text(const Parameter& p, const toml::node& node,
                       const std::string& file) {
  const toml::array* list = node.as_array();
  if (list == nullptr || list->empty()) wrong_type(p, node, file);
  std::string text;
  for (const toml::node& one : *list) {
    if (!text.empty()) text += ',';
    text += number_text(p, one, file);
  }
  return text;
}

std::string rows_text(const Parameter& p, const toml::node& node,
                      const std::string& file) {
  const toml::array* list = node.as_array();
  if (list == nullptr) wrong_type(p, node, file);
  std::string text;
  for (const toml::node& row : *list) {
    if (!text.empty()) text += ';';
    text += p.components > 1 ? tuple_text(p, row, file) : number_text(p, row, file);
  }
  return text;
}

/// A path relative to the scene's folder.
std::string beside_scene(const std::string& path, const std::string& scene) {
  return (std::filesystem::path(scene).parent_path() / path).string();
}

/// Strings of a list, joined by commas; those of a key of files are paths.
std::string texts(const Parameter& p, const toml::node& node, const std::string& file) {
  const toml::array* list = node.as_array();
  if (list == nullptr) wrong_type(p, node, file);
  std::string text;
  for (const toml::node& one : *list) {
    if (!one.is_string()) wrong_type(p, one, file);
    if (!text.empty()) text += ',';
    const std::string name = printable(scalar_text(one));
    refuse_if(name.find(',') != std::string::npos,
              fmt::format("{}: a comma in '{}'", p.name, name),
              place_of(one.source(), file), "give a name without commas");
    text += p.name.ends_with("files") ? beside_scene(name, file) : name;
  }
  return text;
}

std::string value_text(const Parameter& p, const toml::node& node,
                       const std::string& file) {
  if (p.text && p.rows) return texts(p, node, file);
  if (p.text || !p.choices.empty()) {
    const bool flag = p.choices == "true|false" && node.is_boolean();
    if (!node.is_string() && !flag) wrong_type(p, node, file);
    std::string text = printable(scalar_text(node));
    if (!p.text || !p.name.ends_with("file") || text.empty()) return text;
    return beside_scene(text, file);
  }
  if (p.rows && node.is_string()) {
    const std::string name = printable(scalar_text(node)),
                      rows = beside_scene(name, file);
    std::error_code error;
    refuse_if(!std::filesystem::is_regular_file(rows, error),
              fmt::format("{}: there is no file '{}'", p.name, name),
              place_of(node.source(), file),
              "name a file of rows relative to the scene's folder, or give a list");
    return rows_of_file(p, rows);
  }
  if (p.rows) return rows_text(p, node, file);
  return p.components > 1 ? tuple_text(p, node, file) : number_text(p, node, file);
}

[[noreturn]] void unknown_key(std::string_view key, const std::string& name,
                              std::span<const Parameter> declared,
                              std::span<const std::string_view> nested,
                              const std::string& where) {
  std::vector<std::string_view> known(nested.begin(), nested.end());
  for (const Parameter& p : declared) known.push_back(p.name);
  throw InputError(
      fmt::format("unknown key '{}' in {}", key, name), where,
      suggestion(key, known, fmt::format("use one of: {}", fmt::join(known, ", "))));
}

}  // namespace

Table read_table(const toml::table& table, std::span<const Parameter> declared,
                 const std::string& name, const std::string& file,
                 std::span<const std::string_view> nested) {
  Table read(declared, name, place_of(table.source(), file));
  for (const auto& [key, value] : table) {
    const std::string_view word = key.str();
    if (std::ranges::count(nested, word) > 0) continue;
    if (!read.values().knows(word)) {
      unknown_key(word, name, declared, nested, place_of(key.source(), file));
    }
    read_key(table, word, file, read);
  }
  return read;
}

void read_key(const toml::table& table, std::string_view key, const std::string& file,
              Table& read) {
  const toml::node* value = table.get(key);
  if (value == nullptr) return;
  const auto p = std::ranges::find(read.declared(), key, &Parameter::name);
  read.set(key, value_text(*p, *value, file), place_of(value->source(), file));
}

std::vector<const toml::table*> tables_of(const toml::node& node, const std::string& name,
                                          bool many, const std::string& file) {
  const toml::array* list = node.as_array();
  if (list == nullptr) return {&as_table(node, name, file)};
  if (!many) {
    throw InputError(fmt::format("several [[{}]]", name), place_of(node.source(), file),
                     fmt::format("give one [{}]", name));
  }
  std::vector<const toml::table*> all;
  for (const toml::node& one : *list) all.push_back(&as_table(one, name, file));
  return all;
}

const toml::table& as_table(const toml::node& node, const std::string& name,
                            const std::string& file) {
  if (const toml::table* table = node.as_table()) return *table;
  throw InputError(fmt::format("{}: expected a table, got {}", name, kind(node)),
                   place_of(node.source(), file),
                   fmt::format("write [{}] and below it key = value", name));
}

}  // namespace tress::simulation
