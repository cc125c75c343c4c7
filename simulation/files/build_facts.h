#pragma once

#include <string_view>

#include "contract/layers.h"

namespace tress::simulation {

/// What this build was made from: written into manifests and keys of runs.
struct BuildFacts {
  std::string_view version, commit;
  std::string_view source_tree;  // absolute path
  std::string_view compiler, flags, type;
};

const BuildFacts& build_facts();

}  // namespace tress::simulation
