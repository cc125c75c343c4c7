#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string>

#include "contract/layers.h"

namespace tress::experiments {

/// Writes to standard error. A closed or full standard error must not end a long sweep,
/// so failures to write are ignored here (and only here).
template <typename... Args>
void tell(fmt::format_string<Args...> format, Args&&... args) {
  const std::string text = fmt::format(format, std::forward<Args>(args)...);
  std::fputs(text.c_str(), stderr);
}

}  // namespace tress::experiments
