#include "simulation/files/toml_text.h"

#include <fmt/format.h>

#include "contract/input_error.h"
#include "contract/parameters.h"
#include "simulation/files/parse.h"
#include "simulation/files/toml_levels.h"

namespace tress::simulation {
namespace {

/// toml++ has aborted on NUL bytes in some builds, so they are rejected first.
void refuse_nul_bytes(std::string_view text, const std::string& file) {
  const std::size_t at = text.find('\0');
  if (at == std::string_view::npos) return;
  int row = 1, column = 1;
  for (const char c : text.substr(0, at)) {
    column = c == '\n' ? 1 : column + 1;
    row += c == '\n' ? 1 : 0;
  }
  throw InputError("NUL byte in a scene file", fmt::format("{}:{}:{}", file, row, column),
                   "scene files are plain text");
}

}  // namespace

std::string place_of(const toml::source_region& source, const std::string& file) {
  return fmt::format("{}:{}:{}", file, source.begin.line, source.begin.column);
}

toml::table parse_toml(const std::string& text, const std::string& file) {
  refuse_nul_bytes(text, file);
  refuse_deep(text, file);
  try {
    return toml::parse(text, std::string_view(file));
  } catch (const toml::parse_error& error) {
    throw InputError(one_line(error.description()), place_of(error.source(), file),
                     "correct the TOML there");
  }
}

std::string scalar_text(const toml::node& node) {
  if (const auto* text = node.as_string()) return text->get();
  if (const auto* yes = node.as_boolean()) return yes->get() ? "true" : "false";
  if (const auto* whole = node.as_integer()) return std::to_string(whole->get());
  if (const auto* real = node.as_floating_point()) return number_text(real->get());
  return {};
}

}  // namespace tress::simulation
