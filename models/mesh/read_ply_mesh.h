#pragma once

#include <cstddef>
#include <span>

#include "models/mesh/mesh_text.h"
#include "models/mesh/triangle_tree.h"

namespace tress::models {

/// Adds a polygon to a mesh, cut into triangles from its first corner. Fewer than three
/// corners add nothing.
void add_polygon(std::span<const std::size_t> corners, TriangleMesh& to);

/// Reads a PLY file: elements `vertex` with x, y and z, and `face` with the list
/// vertex_indices or vertex_index; others are skipped. Throws InputError as MeshText
/// does.
TriangleMesh read_ply_mesh(MeshText& from);

}  // namespace tress::models
