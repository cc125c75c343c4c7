#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace tress {

/// The text as one line of valid UTF-8: blanks in place of tabs and line ends, \xNN in
/// place of other control characters and of bytes that are not UTF-8.
std::string printable(std::string_view text);

/// printable(), of at most `longest` bytes: a longer text loses its middle.
std::string shortened(std::string_view text, std::size_t longest);

}  // namespace tress
