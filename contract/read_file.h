#pragma once

#include <cstddef>
#include <limits>
#include <string>

namespace tress {

/// Reads a whole regular file of at most `most_bytes`, and never more than one byte
/// beyond that, whatever size the file reports. Throws InputError when it is missing, not
/// a regular file (a folder, a device, a pipe), unreadable or larger. An installed
/// program also finds the files that tress ships (contract/shipped_file.h).
std::string read_file(const std::string& file,
                      std::size_t most_bytes = std::numeric_limits<std::size_t>::max());

}  // namespace tress
