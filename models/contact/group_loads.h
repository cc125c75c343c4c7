#pragma once

#include <array>
#include <cstddef>

#include "math/lanes.h"
#include "math/vec3.h"

namespace tress::models {

/// Number of points of one strand that are treated together.
inline constexpr int points_of_group = 8;
/// Numbers of eight points.
struct alignas(64) GroupNumbers : std::array<double, points_of_group> {};
/// Vectors of eight points.
using GroupVectors = Vec3<GroupNumbers>;
/// Returns the vector of one point.
inline Vec lane_of(const GroupVectors& x, std::size_t lane) {
  return {x.x[lane], x.y[lane], x.z[lane]};
}

/// Load per length on the points of a group from the nearest point of every other strand,
/// and its derivatives: rows of dF/dx, and dF/dv over the identity.
struct GroupLoads {
  GroupVectors force, by_place[3];  // force, and rows of dF/dx
  GroupNumbers by_velocity;         // dF/dv over the identity
};

/// Segments of one strand, one after the other.
struct SegmentRun {
  int first;            // number of the first segment
  unsigned count : 31;  // number of segments
  unsigned last : 1;    // whether the next run is of another strand
};

/// Reads the numbers of consecutive points.
template <class P>
P load(const GroupNumbers& x, std::size_t from) {
  return P::load(&x[from]);
}
/// Reads the vectors of consecutive points.
template <class P>
Vec3<P> load(const GroupVectors& x, std::size_t from) {
  return {load<P>(x.x, from), load<P>(x.y, from), load<P>(x.z, from)};
}
/// Writes the numbers of consecutive points.
template <class P>
void store(const P& x, std::size_t from, GroupNumbers& to) {
  for (int lane = 0; lane < lanes<P>; ++lane) {
    to[from + static_cast<std::size_t>(lane)] = x[lane];
  }
}
/// Writes the vectors of consecutive points.
template <class P>
void store(const Vec3<P>& x, std::size_t from, GroupVectors& to) {
  store(x.x, from, to.x);
  store(x.y, from, to.y);
  store(x.z, from, to.z);
}

}  // namespace tress::models
