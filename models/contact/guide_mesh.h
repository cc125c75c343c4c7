#pragma once

#include <array>
#include <utility>
#include <vector>

#include "contract/basics.h"
#include "math/vec3.h"

namespace tress::models {

/// Returns pairs of neighbouring roots, the lower index first, in ascending order.
/// Neighbours are no farther apart than `width` (m) and have no third root in or on the
/// sphere over their distance. This graph [Gabriel & Sokal 1969] is part of the Delaunay
/// triangulation, so that pairs on a scalp do not cross. O(roots^2).
std::vector<std::pair<int, int>> neighbouring_roots(const std::vector<Vec>& roots,
                                                    double width);

/// Connections of guides with their neighbours at rest. Points are those of all strands,
/// root to tip, strand after strand.
struct GuideMesh {
  /// A point and the nearest one of a neighbour. Neither roots nor tips are linked.
  struct Link {
    int first, second;  // points
    double apart;       // m, at rest
    double carried;     // length of strand that it stands for, m
  };
  /// Between two points of one guide and one of the other.
  struct Triangle {
    int strip;                  // the pair of neighbours
    std::array<int, 3> corner;  // the first two are of one guide
    double width;               // between the guides at rest, m
  };
  std::vector<std::pair<int, int>> strips;  // pairs of neighbouring guides
  std::vector<Link> links;                  // within `width`, ordered
  std::vector<Triangle> triangles;          // in the order of their strips
  std::vector<int> first;                   // point of each strand
  std::vector<int> strand;                  // of each point
  std::vector<double> carried;              // by each point, m

  GuideMesh() = default;
  /// segments[k]: lengths of the segments of strand k, at least two, m; x: where their
  /// ends are at rest, 3 numbers each.
  GuideMesh(const std::vector<std::vector<double>>& segments, In x, double width);
};

/// Distance of the guides at a triangle: the mean of its two sides between them, m.
double width_of(const GuideMesh::Triangle& triangle, In x);

}  // namespace tress::models
