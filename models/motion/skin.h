#pragma once

#include <string>
#include <vector>

#include "models/mesh/triangle_tree.h"
#include "models/motion/root_motion.h"

namespace tress::models {

/// A surface of triangles that deforms over time and carries roots. A root keeps its
/// place and direction relative to the triangle of the first frame that is nearest to it.
/// It keeps its coordinates in that triangle, and its offset in the triangle's axes.
/// These are the first edge, the normal and their product.
class Skin {
 public:
  /// Takes one mesh per time (s, ascending, at least two). Two meshes with the same time
  /// are a teleport, from the first to the second. Throws InputError naming
  /// `where` unless all meshes have the triangles of the first one, corners are finite
  /// and no triangle is without area.
  Skin(std::vector<TriangleMesh> frames, std::vector<double> times,
       const std::string& where);

  /// Returns the motion of a root that is at this place in the first frame. Between
  /// frames places and angles follow cubic splines with continuous acceleration, at rest
  /// before the first frame and after the last, as keyframe_motion(). Throws InputError
  /// if the triangle turns by more than 80 degrees about each of the three axes.
  RootMotion motion(const Vec& position, const Frame& frame) const;

 private:
  StrandPlace axes(std::size_t frame, const NearestOnMesh& on, const Vec& share) const;

  TriangleTree tree_;
  std::vector<std::vector<Vec>> corners_;  // of each frame, m
  std::vector<double> times_;
  std::string where_;
};

}  // namespace tress::models
