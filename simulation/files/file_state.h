#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "contract/layers.h"

namespace tress::simulation {

/// Bytes of a file.
struct FileRange {
  std::uint64_t begin, size;  // first byte, and number of bytes
};

/// State of a file, except for ranges that its writer never changes: enough to restore
/// it, whatever happened to the rest since. It is small where those ranges are large.
struct FileState {
  std::uint64_t length = 0;       // number of bytes of the file
  std::vector<FileRange> ranges;  // that may change, ascending
  std::string bytes;              // theirs, one after the other
};

/// The state of the file now; `unchanging`: in any order, without overlap. Throws
/// InputError when it cannot be read.
FileState state_of(const std::string& file, std::vector<FileRange> unchanging);

/// The file is in that state again, if nothing was written to what does not change.
/// Throws InputError when there is no such file, or it cannot be written.
void restore(const std::string& file, const FileState& state);

}  // namespace tress::simulation
