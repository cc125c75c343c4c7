#pragma once

#include <string>

namespace tress {

/// Returns the path of a file that tress ships, such as scenes/cantilever.toml. This is
/// the path itself if it is absolute or the file exists, otherwise the path in the
/// installed tree of this program. Returns the path unchanged where neither has the file.
std::string shipped_file(const std::string& file);

/// Returns the folder of shipped files in the installed tree of this program; "" if the
/// program is not installed.
const std::string& installed_root();

}  // namespace tress
