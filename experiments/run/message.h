#pragma once

#include <fmt/format.h>

#include <string>

#include "contract/layers.h"

namespace tress::experiments {

/// Writes to standard error. A closed, full or abandoned standard error must not end a
/// long sweep, so failures to write, SIGPIPE among them, are ignored here (and only
/// here).
void tell_text(const std::string& text);

template <typename... Args>
void tell(fmt::format_string<Args...> format, Args&&... args) {
  tell_text(fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace tress::experiments
