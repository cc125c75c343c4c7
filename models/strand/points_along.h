#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "models/strand/strand.h"

namespace tress::models {

/// Returns the arc lengths (m) of the points that a model shows of a strand, from the
/// root. Throws InputError, naming `where`, if these are not the ends of its elements.
std::vector<double> lengths_of_points(const Strand& strand, std::size_t points,
                                      const std::string& where);

/// A point between those of a strand, by the cubic through the nearest four. Its error is
/// of order 4 in their distance, as the error in space of the most accurate model. With
/// equal elements, every point is also a point of the strand with twice the elements.
struct PointBetween {
  std::size_t first = 0, count = 0;  // points that it lies between
  std::array<double, 4> weight{};    // their weights

  /// Returns one coordinate, from the positions (3 points) of the strand.
  double at(const double* x, std::size_t axis) const {
    double sum = 0;
    for (std::size_t i = 0; i < count; ++i) {
      sum += weight[i] * x[3 * (first + i) + axis];
    }
    return sum;
  }
};

/// Returns the point at `place` among points at these ascending places.
PointBetween point_between(double place, const std::vector<double>& among);

}  // namespace tress::models
