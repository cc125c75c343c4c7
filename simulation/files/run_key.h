#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "contract/layers.h"

namespace tress::simulation {

/// Names and values that must agree between an interrupted run and the one that continues
/// it. One line of a file, as JSON.
class RunKey {
 public:
  /// Contains version, commit, build and checksum of this program: no two builds continue
  /// each other's runs.
  RunKey();
  /// Adds a name and its value; returns the same object.
  RunKey& add(std::string name, std::string value);
  std::string line() const;  // without newline

  /// Throws InputError naming the difference when `found`, the first line of `file`, is
  /// the line of another key, or not a key.
  void check(std::string_view found, const std::string& file) const;

 private:
  std::vector<std::pair<std::string, std::string>> parts_;
};

/// Checksum of these files and of those named by a scene among them: every text of a TOML
/// file, escapes resolved, that is a file name relative to its folder. Missing files
/// count as empty; reading them reports the error.
std::string contents_checksum(const std::vector<std::string>& files);

}  // namespace tress::simulation
