#include "contract/shipped_file.h"

#include <unistd.h>

#include <filesystem>

namespace tress {
namespace {

namespace fs = std::filesystem;

bool is_there(const std::string& file) { return ::access(file.c_str(), F_OK) == 0; }

/// Returns the folder, which has a mark so that a build tree is not taken for one.
std::string find_root() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (error) return {};
  const fs::path root = fs::canonical(program.parent_path() / TRESS_SHIPPED_FILES, error);
  if (error || !is_there((root / "installed.json").string())) return {};
  return root.string();
}

}  // namespace

const std::string& installed_root() {
  static const std::string root = find_root();
  return root;
}

std::string shipped_file(const std::string& file) {
  if (file.empty() || file.front() == '/' || is_there(file)) return file;
  if (installed_root().empty()) return file;
  std::string shipped = installed_root() + '/' + file;
  return is_there(shipped) ? shipped : file;
}

}  // namespace tress
