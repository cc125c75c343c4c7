#pragma once

#include <optional>
#include <string>

#include "models/mesh/mesh_grid.h"

namespace tress::models {

/// The file that keeps the grid of one mesh file for later runs.
class GridCache {
 public:
  /// Finds the name of the cache file from the mesh's bytes and the options. Throws
  /// InputError when the mesh file cannot be read.
  GridCache(const std::string& mesh_file, const MeshGridOptions& options);

  /// Returns the grid, or nothing where it is not kept or damaged.
  std::optional<MeshGrid> find() const;
  /// Keeps a grid, if the folder can be written; readers see all of it or nothing.
  void keep(const MeshGrid& made) const;

 private:
  std::string where_, file_;
};

}  // namespace tress::models
