#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "models/contact/body_shapes.h"

namespace tress::models {

/// A signed distance sampled on a regular grid and interpolated by cubic convolution in
/// each direction [Keys 1981, IEEE Trans. ASSP 29(6), eq. 15]: C^1, exact for polynomials
/// of degree 2, error O(spacing^3). The gradient is that of the interpolant, so its
/// length is 1 only up to O(spacing^2). Outside the grid and in its outermost layer the
/// distance is infinite.
class DistanceGrid {
 public:
  /// Samples of the distance on a regular grid.
  struct Samples {
    std::size_t nx = 0, ny = 0, nz = 0;  // points along each axis
    Vec origin;                          // of the first point, m
    double spacing = 0;                  // m
    std::vector<double> value;           // (nx ny nz) m, x fastest; < 0 inside
  };
  /// Throws InputError naming `where` unless there are at least 4 points in each
  /// direction, a finite value for each point, and spacing > 0.
  DistanceGrid(Samples samples, const std::string& where);

  /// Returns the interpolated distance at x, m.
  Distance distance(const Vec& x) const;
  /// Returns the second derivatives at x, 1/m.
  Mat3 curvature(const Vec& x) const;
  /// Finds the nearest point as the other shapes do; packs are looked up lane by lane.
  template <class T>
  NearestOf<T> nearest(const Vec3<T>& x) const {
    NearestOf<T> at;
    for (int lane = 0; lane < lanes<T>; ++lane) {
      const Distance one = distance(lane_of(x, lane));
      set_lane(at.to.value, lane, one.value);
      set_lane(at.to.gradient, lane, one.gradient);
    }
    return at;
  }
  /// Returns the second derivatives of the distance, 1/m.
  template <class T>
  Mat3Of<T> curvature(const Vec3<T>& x, const NearestOf<T>&) const {
    Mat3Of<T> all;
    for (int lane = 0; lane < lanes<T>; ++lane) {
      const Mat3 one = curvature(lane_of(x, lane));
      set_lane(all.r0, lane, one.r0);
      set_lane(all.r1, lane, one.r1);
      set_lane(all.r2, lane, one.r2);
    }
    return all;
  }
  /// Returns the distance from the grid's box outside the box, where no surface is; minus
  /// infinity within.
  template <class T>
  DistanceOf<T> below(const Vec3<T>& x) const {
    const Vec end = s_.origin + s_.spacing * Vec{static_cast<double>(s_.nx - 1),
                                                 static_cast<double>(s_.ny - 1),
                                                 static_cast<double>(s_.nz - 1)};
    const T o(0);
    const auto beyond = [&o](const T& at, double from, double to) {
      return smaller(o, at - T(from)) + larger(o, at - T(to));
    };
    const Vec3<T> out{beyond(x.x, s_.origin.x, end.x), beyond(x.y, s_.origin.y, end.y),
                      beyond(x.z, s_.origin.z, end.z)};
    const T r = square_root(dot(out, out));
    return {where_less(o, r, r, T(-std::numeric_limits<double>::infinity())),
            T(1) / where_less(o, r, r, T(1)) * out};
  }
  /// Returns the samples.
  const Samples& samples() const { return s_; }
  /// The least value in the two outermost layers (m).
  double clearance() const;

 private:
  struct Cell;
  Cell cell(const Vec& x) const;

  Samples s_;
};

/// Reads a text file of numbers separated by blanks or line ends; `#` starts a comment to
/// the end of the line:
///
///     nx ny nz        points per direction, 4 or more and at most 2e7 in all
///     x y z           position of the first point, m
///     spacing         m
///     value ...       nx ny nz signed distances, m, < 0 inside; x fastest, z slowest
///
/// This is the format that SDFGen [Batty, github.com/christopherbatty/SDFGen] writes.
/// Throws InputError with the file and line.
DistanceGrid read_distance_grid(const std::string& file);

}  // namespace tress::models
