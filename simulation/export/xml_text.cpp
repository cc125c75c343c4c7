#include "simulation/export/xml_text.h"

#include <fmt/format.h>

namespace tress::simulation {

std::string xml_text(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    if (c == '&' || c == '<' || c == '>' || c == '"' || c == '\t' || c == '\n' ||
        c == '\r') {
      safe += fmt::format("&#{};", static_cast<int>(c));
    } else {
      safe += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
    }
  }
  return safe;
}

}  // namespace tress::simulation
