#include "experiments/run/options_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "contract/input_error.h"
#include "contract/parameters.h"
#include "contract/read_file.h"
#include "simulation/files/parse.h"
#include "simulation/files/toml_text.h"

namespace tress::experiments {
namespace {

/// A scalar, or a list of scalars joined by commas, as the option of that name accepts.
std::string option_text(const toml::node& node, const std::string& where) {
  const auto text_of = [&where](const toml::node& scalar) {
    std::string text = scalar_text(scalar);
    if (text.empty()) {
      throw InputError("wrong type of value", where,
                       "give a string, a number, or a list of them");
    }
    return text;
  };
  const toml::array* list = node.as_array();
  if (list == nullptr) return text_of(node);
  std::string joined;
  for (const toml::node& entry : *list) {
    if (!joined.empty()) joined += ',';
    joined += text_of(entry);
  }
  return joined;
}

bool flag(const toml::node& node, const std::string& where) {
  if (const auto* yes = node.as_boolean()) return yes->get();
  throw InputError("wrong type of value", where, "give true or false");
}

std::string word(const toml::node& node, const std::string& where) {
  if (const auto* text = node.as_string()) return text->get();
  throw InputError("wrong type of value", where, "give a string");
}

int count(const std::string& text, const std::string& where) {
  return static_cast<int>(parse_whole(text, where, 1, 1'000'000));
}

void read_settings(const toml::node& node, const std::string& where,
                   const std::string& file, CommandLine& line) {
  const toml::table* settings = node.as_table();
  if (settings == nullptr) {
    throw InputError("'settings' is not a table", where,
                     "write [settings] and key = value");
  }
  for (const auto& [key, value] : *settings) {
    const std::string name(key.str());
    const std::string place = place_of(value.source(), file);
    const std::string text = scalar_text(value);
    if (text.empty()) {
      throw InputError("wrong type of value for '" + name + "'", place,
                       "give a number, a string, true or false");
    }
    if (line.places.emplace("set:" + name, place).second)
      line.set.emplace_back(name, text);
  }
}

using ReadOption = void (*)(const toml::node&, const std::string& where, CommandLine&);

constexpr std::pair<std::string_view, ReadOption> readers[] = {
    {"title", [](const toml::node& n, const std::string& where,
                 CommandLine&) { static_cast<void>(word(n, where)); }},
    {"models",
     [](const toml::node& n, const std::string& where, CommandLine& line) {
       line.models = split(option_text(n, where), ',', where);
     }},
    {"integrators",
     [](const toml::node& n, const std::string& where, CommandLine& line) {
       line.integrators = split(option_text(n, where), ',', where);
     }},
    {"plugin",
     [](const toml::node& n, const std::string& where, CommandLine& line) {
       line.plugins = split(option_text(n, where), ',', where);
     }},
    {"elements",
     [](const toml::node& n, const std::string& where, CommandLine& line) {
       line.elements = parse_counts(option_text(n, where), where);
     }},
    {"timeout",
     [](const toml::node& n, const std::string& where, CommandLine& line) {
       line.timeout_s = parse_duration(option_text(n, where), where);
     }},
    {"repeat",
     [](const toml::node& n, const std::string& where, CommandLine& line) {
       line.repeat = count(option_text(n, where), where);
     }},
    {"seed",
     [](const toml::node& n, const std::string& where, CommandLine& line) {
       line.seed = parse_whole(option_text(n, where), where);
     }},
    {"quick", [](const toml::node& n, const std::string& where,
                 CommandLine& line) { line.quick = flag(n, where) && !line.full; }},
    {"full", [](const toml::node& n, const std::string& where,
                CommandLine& line) { line.full = flag(n, where) && !line.quick; }},
};

[[noreturn]] void unknown_key(std::string_view name, const std::string& where) {
  std::vector<std::string_view> known{"settings"};
  for (const auto& [key, read] : readers) known.push_back(key);
  throw InputError(
      fmt::format("unknown key '{}'", name), where,
      suggestion(name, known, fmt::format("use one of: {}", fmt::join(known, ", "))));
}

}  // namespace

void read_options_file(const std::string& file, CommandLine& line) {
  const toml::table options = parse_toml(read_file(file, most_toml_bytes), file);
  if (options["quick"].value_or(false) && options["full"].value_or(false)) {
    throw InputError("quick and full exclude each other",
                     place_of(options.get("full")->source(), file), "give one of them");
  }
  for (const auto& [key, value] : options) {
    const std::string name(key.str());
    const std::string where = place_of(value.source(), file);
    if (name == "settings") {
      read_settings(value, where, file, line);
      continue;
    }
    const auto* reader = std::find_if(std::begin(readers), std::end(readers),
                                      [&](const auto& r) { return r.first == name; });
    if (reader == std::end(readers)) unknown_key(name, place_of(key.source(), file));
    if (line.places.emplace(name, where).second) {
      reader->second(value, where, line);
    } else {
      CommandLine checked;  // the command line overrides, but a wrong value is still an
                            // error
      reader->second(value, where, checked);
    }
  }
}

}  // namespace tress::experiments
