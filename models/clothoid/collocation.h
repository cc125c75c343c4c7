#pragma once

#include <array>
#include <span>
#include <type_traits>

#include "math/lane_choice.h"
#include "models/reduced/reduced_strand.h"
#include "models/strand/element_points.h"

namespace tress::models {

/// Points of an element over a scalar: four in the lanes of a Pack, a block, if the
/// scalar is a number; one a block if strands are in lanes.
template <class Real>
struct PointsOf {
  static constexpr bool in_lanes = std::same_as<Real, double>;  // points are in lanes
  /// Values at the points of a block.
  using Type = std::conditional_t<in_lanes, Pack, Real>;
  static constexpr int of_block = in_lanes ? Pack::lanes : 1;  // points of a block
  /// Capacity: most_clothoid_points of one strand, most_points_of_element of strands in
  /// lanes.
  static constexpr int most = in_lanes ? most_clothoid_points : most_points_of_element;
};

/// Values of a vector at the points of an element, by blocks, and at its tip.
template <class Real>
struct AlongOf {
  /// Values at the points of a block.
  using Points = typename PointsOf<Real>::Type;
  /// Capacity, in blocks.
  static constexpr int most_blocks = PointsOf<Real>::most / PointsOf<Real>::of_block;

  /// Makes values without blocks; their entries are not set.
  AlongOf() {}  // NOLINT
  /// Makes values of `count` blocks; their entries are not set.
  explicit AlongOf(int count) : blocks(count) {}  // NOLINT
  /// Copies the blocks in use and the tip.
  AlongOf(const AlongOf& other) { *this = other; }  // NOLINT
  /// Copies the blocks in use and the tip.
  AlongOf& operator=(const AlongOf& other) {  // NOLINT
    blocks = other.blocks;
    tip = other.tip;
    for (int i = 0; i < 3 * blocks; ++i) entries[i] = other.entries[i];
    return *this;
  }

  /// Returns the vectors at the points of block b.
  Vec3<Points> operator[](int b) const {
    return {entries[3 * b], entries[3 * b + 1], entries[3 * b + 2]};
  }
  /// Sets the vectors at the points of block b.
  void set(int b, const Vec3<Points>& value) {
    entries[3 * b] = value.x;
    entries[3 * b + 1] = value.y;
    entries[3 * b + 2] = value.z;
  }

  int blocks = 0;                   // number of blocks in use
  Vec3<Real> tip;                   // vector at the tip
  Points entries[3 * most_blocks];  // x, y and z of each block
};

/// Gauss collocation on the points of an element that carry its mass. Integrates the
/// polynomial through the values at the points from the element's start to each point and
/// to its tip [Hairer, Lubich, Wanner 2006, Geometric Numerical Integration, II.1.2].
/// With the Legendre polynomials P_m and x in [0, 1],
///
///     A_ij = b_j (x_i + sum_{m=1}^{n-1} P_m(y_j) (P_{m+1}(y_i) - P_{m-1}(y_i))/2),
///
/// y = 2 x - 1. Blocks may hold lanes of no weight, where integrals are interpolated.
template <class Real>
class Collocation {
 public:
  /// Values at the points of a block.
  using Points = typename PointsOf<Real>::Type;

  Collocation() = default;
  /// Constructs the rule from the points of one segment; other segments differ in length
  /// only.
  Collocation(std::span<const PointBlock> points, const Real& length)
      : blocks_(static_cast<int>(points.size())) {
    const Points over = Points(1) / Points(length);
    OfPoints place{}, share{};
    for (int b = 0; b < blocks_; ++b) {
      const PointBlock& block = points[static_cast<std::size_t>(b)];
      const Points x = block.s * over;
      weight_[b] = block.length * over;
      place_[b] = Points(2) * x - Points(1);
      for (int lane = 0; lane < width; ++lane) {
        const auto at = static_cast<std::size_t>(width * b + lane);
        place[at] = place_[b][lane];
        share[at] = weight_[b][lane];
      }
    }
    prepare(place, share);
  }
  /// Constructs the rule of strands in lanes from places and weights on an element of
  /// length 1.
  Collocation(std::span<const double> at, std::span<const double> weight)
      : blocks_(static_cast<int>(at.size())) {
    OfPoints place{}, share{};
    for (std::size_t i = 0; i < at.size(); ++i) {
      place[i] = 2 * at[i] - 1;
      share[i] = weight[i];
      place_[i] = Points(place[i]);
      weight_[i] = Points(share[i]);
    }
    prepare(place, share);
  }

  /// Returns the number of blocks of points.
  int blocks() const { return blocks_; }
  /// Returns y = 2 x - 1 of the points of block b.
  const Points& place(int b) const { return place_[b]; }
  /// Returns the weights of the points of block b; those of all points add up to 1.
  const Points& weight(int b) const { return weight_[b]; }

  /// Returns length times the integral of f over x, from the start to each point and the
  /// tip.
  AlongOf<Real> integral(const AlongOf<Real>& f, const Real& length) const {
    AlongOf<Real> sum(blocks_);
    const Points scale(length);
    for (int b = 0; b < blocks_; ++b) {
      Vec3<Points> at{Points(0), Points(0), Points(0)};
      for (int j = 0; j < blocks_; ++j) {
        const Vec3<Points> from = f[j];
        if constexpr (PointsOf<Real>::in_lanes) {
          for (int lane = 0; lane < width; ++lane) {
            const Points& a = to_[b][width * j + lane];
            at.x += a * Points(from.x[lane]);
            at.y += a * Points(from.y[lane]);
            at.z += a * Points(from.z[lane]);
          }
        } else {
          const Points a(to_[b][j]);
          at = at + a * from;
        }
      }
      sum.set(b, scale * at);
    }
    sum.tip = to_tip(f, length);
    return sum;
  }
  /// Returns length times the integral of f over the whole element.
  Vec3<Real> to_tip(const AlongOf<Real>& f, const Real& length) const {
    Vec3<Points> sum;
    for (int b = 0; b < blocks_; ++b) sum = sum + weight_[b] * f[b];
    return length * over_points(sum);
  }
  /// Returns length times the integral of (2 x - 1) f over the whole element.
  Vec3<Real> moment(const AlongOf<Real>& f, const Real& length) const {
    Vec3<Points> sum;
    for (int b = 0; b < blocks_; ++b) sum = sum + (weight_[b] * place_[b]) * f[b];
    return length * over_points(sum);
  }

 private:
  /// A_ij/b_j for n nodes.
  static double integral(double yi, double yj, int n) {
    double before_i = 1, at_i = yi, before_j = 1, at_j = yj;  // P_{m-1} and P_m
    double sum = (1 + yi) / 2;
    for (int m = 1; m < n; ++m) {
      const double next_i = ((2 * m + 1) * yi * at_i - m * before_i) / (m + 1);
      const double next_j = ((2 * m + 1) * yj * at_j - m * before_j) / (m + 1);
      sum += at_j * (next_i - before_i) / 2;
      before_i = std::exchange(at_i, next_i);
      before_j = std::exchange(at_j, next_j);
    }
    return sum;
  }

  static constexpr int most_blocks = AlongOf<Real>::most_blocks,
                       width = PointsOf<Real>::of_block;
  using OfPoints = std::array<double, PointsOf<Real>::most>;

  /// Sets the entries A_ij from y_i and b_j.
  void prepare(const OfPoints& place, const OfPoints& share) {
    const auto all = static_cast<std::size_t>(width * blocks_);
    const auto nodes = static_cast<int>(std::ranges::count_if(
        std::span(share).first(all), [](double w) { return w > 0; }));
    for (std::size_t i = 0; i < all; ++i) {
      for (std::size_t j = 0; j < all; ++j) {
        const double a = share[j] * integral(place[i], place[j], nodes);
        if constexpr (PointsOf<Real>::in_lanes) {
          to_[i / width][j].set(static_cast<int>(i % width), a);
        } else {
          to_[i][j] = Points(a);
        }
      }
    }
  }
  /// Sum over the points of a block; of strands in lanes it is one.
  static Vec3<Real> over_points(const Vec3<Points>& x) {
    if constexpr (PointsOf<Real>::in_lanes) {
      return sum_over<Real>(x);
    } else {
      return x;
    }
  }

  int blocks_ = 0;
  std::array<Points, most_blocks> place_, weight_;
  std::array<std::array<Points, PointsOf<Real>::most>, most_blocks> to_;
};

}  // namespace tress::models
