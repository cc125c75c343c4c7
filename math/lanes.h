#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>

#include "math/frame.h"
#include "math/pack.h"

/// Operations of kernels that are generic in the scalar: `double`, or a pack with one
/// strand per lane.
namespace tress {

/// Number of lanes of a scalar type: 1 for a number.
template <class Real>
inline constexpr int lanes = 1;
/// Number of lanes of a pack: its width.
template <class Number, int width>
inline constexpr int lanes<PackOf<Number, width>> = width;

/// Returns the number; it has one lane.
inline double lane_of(double x, int /*lane*/) { return x; }
/// Returns the number in a lane.
template <class Number, int width>
double lane_of(const PackOf<Number, width>& x, int lane) {
  return static_cast<double>(x[lane]);
}
/// Returns the vector in a lane.
template <class T>
Vec lane_of(const Vec3<T>& x, int lane) {
  return {lane_of(x.x, lane), lane_of(x.y, lane), lane_of(x.z, lane)};
}
/// Sets the number; it has one lane.
inline void set_lane(double& x, int /*lane*/, double value) { x = value; }
/// Sets the number in a lane.
template <class Number, int width>
void set_lane(PackOf<Number, width>& x, int lane, double value) {
  x.set(lane, static_cast<Number>(value));
}

/// Returns the number; it has one lane.
inline double largest(double x) { return x; }
/// Returns the largest number of all lanes.
template <class Number, int width>
double largest(const PackOf<Number, width>& x) {
  Number most = x[0];
  for (int lane = 1; lane < width; ++lane) most = std::max(most, x[lane]);
  return static_cast<double>(most);
}
/// Returns true if the number is finite.
inline bool is_finite(double x) { return std::isfinite(x); }
/// Returns true if the numbers of all lanes are finite.
template <class Number, int width>
bool is_finite(const PackOf<Number, width>& x) {
  return std::isfinite(sum(x - x));
}

/// Sum over four points of one strand; unchanged when lanes are strands, since each lane
/// then holds its own point.
template <class Real>
Real sum_over(const Pack& points) {
  if constexpr (std::same_as<Real, Pack>) {
    return points;
  } else {
    return sum(points);
  }
}

/// Returns the sum of vectors over four points, as the sum of numbers.
template <class Real>
Vec3<Real> sum_over(const Vec3<Pack>& points) {
  return {sum_over<Real>(points.x), sum_over<Real>(points.y), sum_over<Real>(points.z)};
}

/// Sets the vector in a lane.
template <class T>
void set_lane(Vec3<T>& to, int lane, const Vec& x) {
  set_lane(to.x, lane, x.x);
  set_lane(to.y, lane, x.y);
  set_lane(to.z, lane, x.z);
}
/// Sets the frame in a lane.
template <class T>
void set_lane(FrameOf<T>& to, int lane, const Frame& f) {
  set_lane(to.e0, lane, f.e0);
  set_lane(to.e1, lane, f.e1);
  set_lane(to.e2, lane, f.e2);
}

/// Loads (stores) the vectors of four points that lie `step` numbers apart.
inline Vec3<Pack> gather3(const double* p, std::size_t step) {
  const auto entry = [=](std::size_t k) {
    return Pack(p[k], p[k + step], p[k + 2 * step], p[k + 3 * step]);
  };
  return {entry(0), entry(1), entry(2)};
}
/// Writes the vectors of four lanes, three numbers each, `step` numbers apart.
inline void scatter3(const Vec3<Pack>& x, double* p, std::size_t step) {
  for (int lane = 0; lane < Pack::lanes; ++lane, p += step) {
    store3(Vec{x.x[lane], x.y[lane], x.z[lane]}, p);
  }
}

}  // namespace tress
