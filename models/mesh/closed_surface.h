#pragma once

#include <array>
#include <string>
#include <vector>

#include "models/mesh/triangle_tree.h"

namespace tress::models {

/// The signed distance to a closed surface of triangles, negative inside. The sign is
/// that of the angle-weighted normal at the nearest place [Baerentzen & Aanaes 2005, IEEE
/// Trans. Vis. Comput. Graph. 11(3), section 4].
class ClosedSurface {
 public:
  /// Corners at one place become one, and triangles with two equal corners are left out.
  /// Triangles face outwards afterwards, whichever way all of them faced. Throws
  /// InputError naming `where` unless every edge belongs to two triangles that face the
  /// same way, all numbers are finite, and the volume is not 0.
  ClosedSurface(const TriangleMesh& mesh, const std::string& where);

  /// Returns the signed distance from a place, m. `from`: a triangle near it, which is
  /// that of the nearest place afterwards.
  double distance(const Vec& x, std::size_t& from) const;
  /// Returns the signed distance from a place, m.
  double distance(const Vec& x) const;
  /// Returns corners and triangles, outwards by the right-hand rule.
  const TriangleMesh& mesh() const { return tree_.mesh(); }
  /// Returns the volume, m^3.
  double volume() const { return volume_; }

 private:
  const Vec& normal(const NearestOnMesh& on) const;

  TriangleTree tree_;
  double volume_ = 0;                     // m^3
  std::vector<Vec> face_, corner_;        // normals: unit; sums weighted by angles
  std::vector<std::array<Vec, 3>> edge_;  // sums over the two triangles of an edge
};

}  // namespace tress::models
