#pragma once

#include <string>
#include <string_view>

#include "contract/layers.h"

namespace tress::simulation {

/// A file that one process at a time writes; a second one is refused while it is open.
class LockedFile {
 public:
  /// Created where there is none. Throws InputError when it cannot be written, is no
  /// regular file, or another process holds it: "another run is writing `what`".
  LockedFile(std::string file, std::string_view what);
  ~LockedFile();
  LockedFile(const LockedFile&) = delete;
  LockedFile& operator=(const LockedFile&) = delete;

  int descriptor() const { return descriptor_; }
  /// The whole content. Not by another descriptor: closing one would end the lock.
  std::string read() const;
  /// Keeps the first `bytes` bytes; what is written next follows them.
  void truncate(std::size_t bytes) const;
  void remove() const;

 private:
  void open();
  bool lock(std::string_view what) const;

  std::string file_;
  int descriptor_ = -1;
};

}  // namespace tress::simulation
