#pragma once

#include <span>
#include <string>
#include <vector>

#include "contract/layers.h"

namespace tress::simulation {

/// Plug-in that was loaded.
struct LoadedPlugin {
  std::string file;                                       // as it was given
  std::string checksum;                                   // of its bytes
  std::vector<std::string> models, integrators, effects;  // ids that it brought
};

/// Opens the shared library for the life of the process and adds its entries to the
/// catalogues. Must be called before they are first read, and before other threads run.
/// Throws InputError in these cases:
///
/// - The file is missing or no plug-in.
/// - It was built for another version of tress or in another way than this program.
///   Nothing of the library is run then.
/// - It throws, exits or crashes when it is loaded.
/// - A catalogue refuses an entry.
void load_plugin(const std::string& file);

/// Returns the plug-ins in the order in which they were loaded.
std::span<const LoadedPlugin> loaded_plugins();

}  // namespace tress::simulation
