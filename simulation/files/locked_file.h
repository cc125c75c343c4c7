#pragma once

#include <string>
#include <string_view>

#include "contract/layers.h"

namespace tress::simulation {

/// A file that only one process at a time can write; a second one is refused meanwhile.
class LockedFile {
 public:
  /// Created if it does not exist. Throws InputError when it cannot be written, is not a
  /// regular file, or another process holds it: "another run is writing `what`".
  LockedFile(std::string file, std::string_view what);
  ~LockedFile();
  LockedFile(const LockedFile&) = delete;
  LockedFile& operator=(const LockedFile&) = delete;

  /// Returns the descriptor of the operating system.
  int descriptor() const { return descriptor_; }
  /// The whole content. Reads through the same descriptor: closing another one would
  /// release the lock.
  std::string read() const;
  /// Keeps the first `bytes` bytes; later writes follow them.
  void truncate(std::size_t bytes) const;
  /// Deletes the file.
  void remove() const;

 private:
  void open();
  bool lock(std::string_view what) const;

  std::string file_;
  int descriptor_ = -1;
};

}  // namespace tress::simulation
