#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace tress::experiments::divided_heads {

/// A folder of a name that nobody could guess, for this user alone; removed in the end.
class PrivateFolder {
 public:
  PrivateFolder();
  ~PrivateFolder();
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// A program that runs at the same time as this one, its output in a file. No shell
/// reads its words.
class Launched {
 public:
  /// Looked for on the PATH. Throws std::system_error when it cannot be started.
  Launched(const std::vector<std::string>& words, const std::string& log);
  ~Launched();  // waits for it
  Launched(Launched&& other) noexcept;
  Launched& operator=(Launched&&) = delete;

  /// Waits for it; true: it ended with exit code 0.
  bool succeeds();

 private:
  pid_t process_ = -1;
};

}  // namespace tress::experiments::divided_heads
