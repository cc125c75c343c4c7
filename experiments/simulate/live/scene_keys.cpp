#include "experiments/simulate/live/scene_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <sstream>

#include "contract/input_error.h"
#include "simulation/scene/scene_tables.h"

namespace tress::experiments::scene_runs {
namespace {

using nlohmann::json;

void gather(const toml::node& node, const std::string& path, json& all) {
  if (const toml::table* table = node.as_table()) {
    for (const auto& [key, inner] : *table) {
      gather(inner, path.empty() ? std::string(key) : path + "." + std::string(key), all);
    }
  } else if (node.is_number()) {
    all[path] = *node.value<double>();
  } else if (const toml::array* list = node.as_array()) {
    if (!list->empty() && std::ranges::all_of(*list, &toml::node::is_number)) {
      for (const toml::node& x : *list) all[path].push_back(*x.value<double>());
    } else if (list->is_array_of_tables()) {
      for (std::size_t i = 0; i < list->size(); ++i) {
        gather((*list)[i], fmt::format("{}.{}", path, i), all);
      }
    }
  }
}

/// Adds the keys that a table leaves at their defaults.
void add_defaults(const toml::table& table, const std::string& path,
                  const TableEntry& entry, json& all) {
  for (const Parameter& p : entry.parameters) {
    const bool number = p.choices.empty() && !p.text && !p.rows;
    if (!number || table.contains(p.name)) continue;
    const json value = json::parse("[" + p.default_text() + "]", nullptr, false);
    if (!value.is_array() || value.empty()) continue;
    all[fmt::format("{}.{}", path, p.name)] = p.components > 1 ? value : value.front();
  }
}

/// Of one table, or of each in a list.
void add_defaults(const toml::table& scene, const TableEntry& entry, json& all) {
  const auto at = scene.at_path(entry.name);
  const std::string name(entry.name);
  if (const toml::table* table = at.as_table()) add_defaults(*table, name, entry, all);
  const toml::array* list = at.as_array();
  for (std::size_t i = 0; list != nullptr && i < list->size(); ++i) {
    if (const toml::table* table = (*list)[i].as_table()) {
      add_defaults(*table, fmt::format("{}.{}", name, i), entry, all);
    }
  }
}

[[noreturn]] void refuse_value(const std::string& path) {
  throw InputError("the value is no number, word, truth value or list of numbers", path,
                   "give for example 0.5, false or [0, 0, 1]");
}

}  // namespace

json scene_keys(const toml::table& scene) {
  json all = json::object();
  gather(scene, "", all);
  for (const TableEntry& entry : table_entries()) add_defaults(scene, entry, all);
  return all;
}

void set_key(toml::table& scene, const std::string& path, const json& value) {
  toml::node* at = &scene;
  std::istringstream words(path);
  std::string word, next;
  std::getline(words, word, '.');
  while (std::getline(words, next, '.')) {
    if (toml::array* list = at->as_array()) {
      std::size_t i = 0;
      const auto [end, error] =
          std::from_chars(word.data(), word.data() + word.size(), i);
      const bool read = error == std::errc() && end == word.data() + word.size();
      at = read ? list->get(i) : nullptr;
    } else {
      toml::table* table = at->as_table();
      at = table == nullptr ? nullptr : table->get(word);
    }
    refuse_if(at == nullptr, fmt::format("the scene has no table '{}'", word), path,
              "name a key of a table that the scene has, such as strand.length_m");
    word = next;
  }
  toml::table* const table = at->as_table();
  refuse_if(table == nullptr || word.empty(), "this is no key of a scene", path,
            "name a key of a table that the scene has, such as strand.length_m");
  if (value.is_boolean()) {
    table->insert_or_assign(word, value.get<bool>());
  } else if (value.is_number_integer()) {
    table->insert_or_assign(word, value.get<std::int64_t>());
  } else if (value.is_number()) {
    table->insert_or_assign(word, value.get<double>());
  } else if (value.is_string()) {
    table->insert_or_assign(word, value.get<std::string>());
  } else if (value.is_array()) {
    toml::array list;
    for (const json& x : value) {
      if (!x.is_number()) refuse_value(path);
      list.push_back(x.get<double>());
    }
    table->insert_or_assign(word, std::move(list));
  } else {
    refuse_value(path);
  }
}

}  // namespace tress::experiments::scene_runs
