#pragma once

#include <source_location>

#include "contract/input_error.h"

namespace tress {

/// Marks a part of a source from `./tress new` that its author has still to write: throws
/// InputError with `what`, file and line. Not for functions that are noexcept.
[[noreturn]] inline void fill_in(
    const std::string& what,
    std::source_location where = std::source_location::current()) {
  throw InputError("still to be written: " + what,
                   std::string(where.file_name()) + ":" + std::to_string(where.line()) +
                       ":" + std::to_string(where.column()),
                   "write it in place of this call of fill_in()");
}

}  // namespace tress
