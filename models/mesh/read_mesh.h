#pragma once

#include <string>

#include "models/mesh/triangle_tree.h"

namespace tress::models {

/// Reads the triangles of a mesh file: Wavefront OBJ (v and f), PLY (text or binary) or
/// STL (text or binary), by the ending of its name. Polygons are cut into triangles from
/// their first corner, and all objects of the file become one mesh. `scale`: metres per
/// unit of the file. Throws InputError with file and line or byte when it has another
/// ending, is larger than 1 GiB, does not parse, or has no triangle. O(bytes).
TriangleMesh read_mesh(const std::string& file, double scale);

}  // namespace tress::models
