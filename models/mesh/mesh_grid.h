#pragma once

#include <cstddef>
#include <string>

#include "models/contact/distance_grid.h"
#include "models/mesh/closed_surface.h"

namespace tress::models {

/// A distance grid computed from a mesh, and how far it is true to it.
struct MeshGrid {
  DistanceGrid grid;          // signed distances
  std::size_t triangles = 0;  // number of triangles of the mesh
  /// Largest distance (m) of the grid's surface at corners, middles of edges and centres
  /// of triangles of the mesh.
  double error = 0;
};

/// Settings of the grid of a mesh file.
struct MeshGridOptions {
  double scale = 1;    // metres per unit of the file
  double spacing = 0;  // m, between grid points; 0: a 64th of the largest extent
  double offset = 0;   // m, distance at which contact begins: strands' radius
};

/// Returns the signed distance of a closed surface on a grid around it. `where` names the
/// surface in errors. Throws InputError when the spacing needs more than 2e7 points, or
/// when neighbouring values differ by more than their spacing, which no signed distance
/// does: the surface intersects itself there.
MeshGrid mesh_grid(const ClosedSurface& surface, const MeshGridOptions& options,
                   const std::string& where);

/// Reads a mesh (see read_mesh()) and returns its grid. The grid of a file is computed
/// once: it is kept in $XDG_CACHE_HOME/tress/meshes (~/.cache if unset), under a name
/// that depends on the file's bytes and on the options. A cache that cannot be read or
/// written costs time only. Throws InputError as read_mesh(), ClosedSurface and
/// mesh_grid() do.
MeshGrid read_mesh_grid(const std::string& file, const MeshGridOptions& options);

}  // namespace tress::models
