#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "math/vec3.h"

namespace tress::simulation {

/// Strands as polylines, root first.
struct Polylines {
  std::vector<Vec> points;            // points of all strands, strand after strand
  std::vector<std::size_t> ends;      // of each strand, one after its last point
  std::vector<std::size_t> numbers;   // of each strand in its file, from 0
  std::vector<std::uint64_t> places;  // there: the byte, or the line, where it ends

  /// Returns the number of strands.
  std::size_t size() const { return ends.size(); }
  /// Returns the points of strand k.
  std::span<const Vec> strand(std::size_t k) const {
    const std::size_t from = k == 0 ? 0 : ends[k - 1];
    return std::span(points).subspan(from, ends[k] - from);
  }
  /// The points since the last end are a strand.
  void end_strand(std::size_t number, std::uint64_t place) {
    ends.push_back(points.size());
    numbers.push_back(number);
    places.push_back(place);
  }
};

}  // namespace tress::simulation
