#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "contract/layers.h"

namespace tress::simulation {

/// What must agree between a run that was interrupted and the one that continues it: what
/// it is called and its value. One line of a file, as JSON.
class RunKey {
 public:
  /// With version and commit of this program.
  RunKey();
  RunKey& add(std::string name, std::string value);
  std::string line() const;  // without its end

  /// Throws InputError saying what differs when `found`, the first line of `file`, is the
  /// line of another key, or of none.
  void check(std::string_view found, const std::string& file) const;

 private:
  std::vector<std::pair<std::string, std::string>> parts_;
};

/// Checksum of these files and of those that a scene among them names: every quoted text
/// of a .toml file that is the name of a file, seen from its folder. What does not exist
/// counts as empty: whoever reads it complains.
std::string contents_checksum(const std::vector<std::string>& files);

}  // namespace tress::simulation
