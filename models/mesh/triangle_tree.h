#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "math/vec3.h"

namespace tress::models {

/// Corners and triangles of a surface, as a file lists them.
struct TriangleMesh {
  std::vector<Vec> corner;                           // m
  std::vector<std::array<std::size_t, 3>> triangle;  // indices of corners
};

/// The place of a mesh that is nearest to another place.
struct NearestOnMesh {
  std::size_t triangle = 0;  // its triangle
  Vec at;                    // the place, m
  int corner = -1;           // 0 to 2: it is this corner of the triangle
  int edge = -1;             // 0 to 2: it is inside the edge from this corner to the next
};

/// Finds the nearest triangle of a mesh by a tree of boxes, in O(log n).
class TriangleTree {
 public:
  /// Builds the tree of at least one triangle. All corners must be finite.
  explicit TriangleTree(TriangleMesh mesh);
  ~TriangleTree();
  /// Takes over the tree of another object, which must not be used any more.
  TriangleTree(TriangleTree&&) noexcept;

  /// Returns the place of the mesh that is nearest to x (m). The search is faster from a
  /// triangle that is near: `from`, such as that of a neighbour of x.
  NearestOnMesh nearest(const Vec& x, std::size_t from = 0) const;
  /// Returns the mesh.
  const TriangleMesh& mesh() const;

 private:
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

}  // namespace tress::models
