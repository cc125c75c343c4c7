#pragma once

#include <string>
#include <string_view>

#include "contract/layers.h"
#include "contract/read_file.h"

namespace tress::simulation {

/// An open file; closed on every path.
class File {
 public:
  /// As open(2) with mode 0644; throws InputError naming `file` on failure.
  File(const std::string& file, int flags);
  ~File();
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

/// Writes all bytes to the descriptor; throws InputError naming `file` when it cannot
/// (disk full, file too large, device gone).
void write_all(int descriptor, std::string_view text, const std::string& file);

/// Writes to a temporary neighbour, syncs it, then renames it over `file`: readers see
/// the old content or the new, never a partial one.
void replace_file(const std::string& file, std::string_view text);

/// Refuses, before any work, an output that could not be written at the end: a directory,
/// a device, a missing or unwritable parent.
void check_output(const std::string& file);

/// `file` without a final ".csv", followed by `ending`.
std::string beside(const std::string& file, std::string_view ending);

}  // namespace tress::simulation
