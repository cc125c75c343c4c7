#pragma once

#include <array>
#include <vector>

#include "contract/basics.h"
#include "contract/pattern.h"
#include "math/vec3.h"
#include "models/maximal/groups.h"

namespace tress::models {

/// A point of the strand as the weighted mean of up to four consecutive nodes.
struct NodeMean {
  int first = 0;                    // node
  int nodes = 1;                    // number of nodes
  std::array<double, 4> weight{1};  // weights of the nodes

  /// Returns the mean of vectors at the nodes.
  Vec of(In values) const {  // (3 nodes)
    Vec sum;
    for (int k = 0; k < nodes; ++k) {
      sum = sum + weight[static_cast<std::size_t>(k)] *
                      load3(&values[3 * static_cast<std::size_t>(first + k)]);
    }
    return sum;
  }
};

/// Unit tangents of a strand at its mass points, t_i = d/|d|, with d from the point
/// before to the next one. At the ends d starts or ends at the point itself. Also adds
/// the contribution of their derivatives
///
///     dt_i = (I - t_i t_i^T) (dx_behind - dx_before)/|d|
///
/// to the tangent of loads that depend on them. O(points).
class PointDirections {
 public:
  /// `held` coordinates are prescribed.
  PointDirections(std::vector<NodeMean> points, int held);

  /// Tangents t at positions x of the points, (3 points) each.
  void tangents(In x, Out t) const;

  // As in Groups, for S.
  /// Adds the pairs of S that the tangents couple.
  void couple(std::vector<std::vector<int>>& columns) const { groups_.couple(columns); }
  /// Looks up the entries of S.
  void bind(const Pattern& pattern) { groups_.bind(pattern); }
  /// s += sum_i w_i blocks_i dt_i/dz with w_i the weights of point i; blocks (9 points)
  /// row-major.
  void add_tangent(In x, In t, In blocks, Out s) const;

 private:
  std::size_t before(std::size_t i) const { return i == 0 ? 0 : i - 1; }
  std::size_t behind(std::size_t i) const { return i + 1 == points_.size() ? i : i + 1; }
  std::vector<std::vector<int>> groups() const;

  std::vector<NodeMean> points_;
  Groups groups_;  // per point, from the first node of `before` to the last of `behind`
};

}  // namespace tress::models
