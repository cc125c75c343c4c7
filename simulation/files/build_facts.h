#pragma once

#include <string>
#include <string_view>

#include "contract/layers.h"

namespace tress::simulation {

/// Provenance of this build, written into manifests and run keys.
struct BuildFacts {
  std::string_view version;      // version of tress
  std::string_view commit;       // of the tree that was compiled, or "unknown"
  std::string_view changes;      // checksum of its differences from the commit; "": none
  std::string_view source_tree;  // absolute path; "": of a package
  std::string_view compiler;     // name and version
  std::string_view flags, type;  // of the compiler; CMake's build type

  /// Returns true if the sources differ from the commit.
  bool dirty() const { return !changes.empty(); }
  /// The commit, and the changes where there are some.
  std::string code() const;
  /// The lines that `program --version` prints: version and commit, build, and the
  /// vector instructions of the compiler and of this machine.
  std::string described(std::string_view program) const;
};

/// Returns the facts of this build.
const BuildFacts& build_facts();

/// Checksum of the file that this process runs, 16 hexadecimal digits; "unknown" where it
/// cannot be read.
const std::string& executable_checksum();

/// Commit that is checked out in a source tree, read from its .git without calling git;
/// empty where there is none, or it is stored in another way.
std::string checked_out(std::string_view source_tree);

}  // namespace tress::simulation
