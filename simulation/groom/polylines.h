#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "math/vec3.h"

namespace tress::simulation {

/// Strands as polylines, root first.
struct Polylines {
  std::vector<Vec> points;            // points of all strands, strand after strand
  std::vector<double> widths;         // diameter at each point; empty: not known
  std::vector<std::size_t> ends;      // of each strand, one after its last point
  std::vector<std::size_t> numbers;   // of each strand in its file, from 0
  std::vector<std::uint64_t> places;  // there: the byte, or the line, where it ends

  /// Returns the number of strands.
  std::size_t size() const { return ends.size(); }
  /// Returns the points of strand k.
  std::span<const Vec> strand(std::size_t k) const { return part(points, k); }
  /// Returns the diameters at the points of strand k; empty: they are not known.
  std::span<const double> widths_of(std::size_t k) const {
    return widths.empty() ? std::span<const double>() : part(widths, k);
  }
  /// The points since the last end are a strand.
  void end_strand(std::size_t number, std::uint64_t place) {
    ends.push_back(points.size());
    numbers.push_back(number);
    places.push_back(place);
  }

 private:
  template <class T>
  std::span<const T> part(const std::vector<T>& all, std::size_t k) const {
    const std::size_t from = k == 0 ? 0 : ends[k - 1];
    return std::span(all).subspan(from, ends[k] - from);
  }
};

}  // namespace tress::simulation
