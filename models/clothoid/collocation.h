#pragma once

#include <array>
#include <span>

#include "models/reduced/reduced_strand.h"

namespace tress::models {

/// Values of a vector at the points of an element, four a block (or, if Real is a pack,
/// one point of four elements), and at its tip.
template <class Real>
struct AlongOf {
  static constexpr int most_blocks = most_clothoid_points * lanes<Real> / Pack::lanes;

  // Only those in use are set and copied.
  AlongOf() {
  }  // NOLINT(modernize-use-equals-default,cppcoreguidelines-pro-type-member-init)
  explicit AlongOf(int count) : blocks(count) {}    // NOLINT
  AlongOf(const AlongOf& other) { *this = other; }  // NOLINT
  AlongOf& operator=(
      const AlongOf& other) {  // NOLINT(bugprone-unhandled-self-assignment)
    blocks = other.blocks;
    tip = other.tip;
    for (int b = 0; b < blocks; ++b) {
      x[b] = other.x[b];
      y[b] = other.y[b];
      z[b] = other.z[b];
    }
    return *this;
  }

  Vec3<Pack> operator[](int b) const { return {x[b], y[b], z[b]}; }
  void set(int b, const Vec3<Pack>& value) {
    x[b] = value.x;
    y[b] = value.y;
    z[b] = value.z;
  }

  int blocks = 0;
  Vec3<Real> tip;
  Pack x[most_blocks], y[most_blocks], z[most_blocks];
};

/// Gauss collocation on the points of an element that carry its mass: integrals from its
/// start to each point, of the polynomial through the values at the points, and to its
/// tip [Hairer, Lubich, Wanner 2006, Geometric Numerical Integration, II.1.2]. With the
/// Legendre polynomials P_m and x in [0, 1],
///
///     A_ij = b_j (x_i + sum_{m=1}^{n-1} P_m(y_j) (P_{m+1}(y_i) - P_{m-1}(y_i))/2),
///
/// y = 2 x - 1. Blocks may hold lanes of no weight, where integrals are interpolated.
template <class Real>
class Collocation {
 public:
  Collocation() = default;
  /// By the points of one segment; those of others are the same but for their length.
  Collocation(std::span<const PointBlock> points, const Real& length)
      : blocks_(static_cast<int>(points.size())) {
    constexpr int width = lanes<Real> == 1 ? Pack::lanes : 1;  // points in a block
    const Pack over = Pack(1) / Pack(length);
    std::array<double, most_clothoid_points> place{}, share{};
    for (int b = 0; b < blocks_; ++b) {
      const PointBlock& block = points[static_cast<std::size_t>(b)];
      const Pack x = block.s * over;
      weight_[b] = block.length * over;
      place_[b] = Pack(2) * x - Pack(1);
      for (int lane = 0; lane < width; ++lane) {
        const auto at = static_cast<std::size_t>(width * b + lane);
        place[at] = place_[b][lane];
        share[at] = weight_[b][lane];
      }
    }
    const auto all = static_cast<std::size_t>(width * blocks_);
    const auto nodes = static_cast<int>(std::ranges::count_if(
        std::span(share).first(all), [](double w) { return w > 0; }));
    for (std::size_t i = 0; i < all; ++i) {
      for (std::size_t j = 0; j < all; ++j) {
        const double a = share[j] * integral(place[i], place[j], nodes);
        if constexpr (width == 1) {
          to_[j][i] = Pack(a);
        } else {
          to_[j][i / width].set(static_cast<int>(i % width), a);
        }
      }
    }
  }

  int blocks() const { return blocks_; }
  const Pack& place(int b) const { return place_[b]; }  // 2 x - 1

  /// length times the integral to each point and the tip.
  AlongOf<Real> integral(const AlongOf<Real>& f, const Real& length) const {
    AlongOf<Real> sum(blocks_);
    for (int b = 0; b < blocks_; ++b) sum.set(b, {Pack(0), Pack(0), Pack(0)});
    const auto add = [&](const auto& at, const Pack& x, const Pack& y, const Pack& z) {
      for (int b = 0; b < blocks_; ++b) {
        sum.x[b] += at[b] * x;
        sum.y[b] += at[b] * y;
        sum.z[b] += at[b] * z;
      }
    };
    for (int j = 0; j < blocks_; ++j) {
      if constexpr (lanes<Real> == 1) {
        for (int lane = 0; lane < Pack::lanes; ++lane) {
          add(to_[Pack::lanes * j + lane], f.x[j][lane], f.y[j][lane], f.z[j][lane]);
        }
      } else {
        add(to_[j], f.x[j], f.y[j], f.z[j]);
      }
    }
    const Pack scale(length);
    for (int b = 0; b < blocks_; ++b) sum.set(b, scale * sum[b]);
    sum.tip = to_tip(f, length);
    return sum;
  }
  /// length times the integral over the whole.
  Vec3<Real> to_tip(const AlongOf<Real>& f, const Real& length) const {
    Vec3<Pack> sum;
    for (int b = 0; b < blocks_; ++b) sum = sum + weight_[b] * f[b];
    return length * sum_over<Real>(sum);
  }
  /// The integral of (2 x - 1) f, the same way.
  Vec3<Real> moment(const AlongOf<Real>& f, const Real& length) const {
    Vec3<Pack> sum;
    for (int b = 0; b < blocks_; ++b) sum = sum + (weight_[b] * place_[b]) * f[b];
    return length * sum_over<Real>(sum);
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

  static constexpr int most_blocks = AlongOf<Real>::most_blocks;
  int blocks_ = 0;
  std::array<Pack, most_blocks> place_, weight_;
  std::array<std::array<Pack, most_blocks>, most_clothoid_points> to_;
};

}  // namespace tress::models
