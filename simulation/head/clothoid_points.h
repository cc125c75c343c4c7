#pragma once

#include <span>
#include <vector>

#include "models/clothoid/clothoid.h"

namespace tress::simulation {

/// Points of one element at a time of strands of linear curvature.
class ClothoidPoints {
 public:
  /// Takes places and weights of the points on an element of length 1.
  ClothoidPoints(std::span<const double> at, std::span<const double> weight)
      : count_(at.size()), rule_(blocks(at, weight), 1) {}

  /// Point of an element, in the frame of its start.
  struct Point {
    Vec position, velocity, tangent;  // m, m/s; at a start that does not move
  };
  /// Moves to an element of this strain (1/m), its rate and length (m).
  void place(const models::LinearStrain& strain, const models::LinearStrain& rate,
             double length) {
    curve_ = Curve(strain, length, rule_);
    turning_ = curve_.turn(rate);
    moving_ = curve_.moved(turning_);
  }
  /// Returns point k.
  Point point(std::size_t k) const {
    const int block = static_cast<int>(k) / width, lane = static_cast<int>(k) % width;
    return {lane_of(curve_.position()[block], lane), lane_of(moving_[block], lane),
            lane_of(curve_.tangent(block), lane)};
  }
  /// Returns the number of points.
  std::size_t count() const { return count_; }
  /// Returns the frame of the tip.
  const Frame& rotation() const { return curve_.rotation({}); }
  /// Returns the angular velocity of the tip, 1/s.
  const Vec& turning() const { return turning_.tip; }

 private:
  using Curve = models::ClothoidCurveOf<double>;
  static constexpr int width = Pack::lanes;

  static std::vector<models::PointBlock> blocks(std::span<const double> at,
                                                std::span<const double> weight) {
    std::vector<models::PointBlock> all((at.size() + width - 1) / width);
    for (auto& block : all) block = {Pack(0.5), Pack(0), Pack(0)};
    for (std::size_t k = 0; k < at.size(); ++k) {
      const int lane = static_cast<int>(k) % width;
      all[k / width].s.set(lane, at[k]);
      all[k / width].length.set(lane, weight[k]);
    }
    return all;
  }

  std::size_t count_;
  models::Collocation<double> rule_;
  Curve curve_;
  Curve::Along turning_, moving_;
};

}  // namespace tress::simulation
