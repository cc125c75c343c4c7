#pragma once

#include <string_view>

#include "contract/layers.h"

namespace tress::simulation {

/// Provenance of this build, written into manifests and run keys.
struct BuildFacts {
  std::string_view version, commit;
  std::string_view source_tree;  // absolute path
  std::string_view compiler, flags, type;
};

const BuildFacts& build_facts();

}  // namespace tress::simulation
