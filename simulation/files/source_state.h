#pragma once

#include <string>

#include "contract/layers.h"

namespace tress::simulation {

/// The source tree's commit when this runs, or the one it was built from.
struct SourceState {
  std::string commit;
  bool dirty = false;  // tracked files other than results/ differ from the commit
};
SourceState source_state();

}  // namespace tress::simulation
