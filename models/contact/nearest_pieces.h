#pragma once

#include <span>

#include "models/contact/segment_grid.h"

namespace tress::models {

/// The point of a polyline nearest to another point.
struct NearestPiece {
  int segment;
  double s;  // position on it
  Vec gap;   // vector from there
};

/// Calls found(NearestPiece) for every polyline but `own` within reach of x, in their
/// order; piece_of(segment) is where a segment is.
template <class Pieces, class F>
void each_nearest(const SegmentGrid& grid, const Pieces& piece_of, double reach, int own,
                  const Vec& x, F found) {
  const std::span<const SegmentGrid::Entry> near = grid.near(x);
  const double far = reach * reach;
  for (std::size_t k = 0; k < near.size();) {
    const int other = near[k].polyline;
    if (other == own) {
      ++k;
      continue;
    }
    NearestPiece nearest{};
    double least = far;
    for (; k < near.size() && near[k].polyline == other; ++k) {
      const StraightPiece& piece = piece_of(near[k].segment);
      const double s = piece.nearest(x);
      const Vec gap = x - piece.at(s);
      const double square = dot(gap, gap);
      if (!(square < least)) continue;
      least = square;
      nearest = {near[k].segment, s, gap};
    }
    if (least < far) found(nearest);
  }
}

/// As above, with the segments where they were at SegmentGrid::update.
template <class F>
void each_nearest(const SegmentGrid& grid, double reach, int own, const Vec& x, F found) {
  const auto there = [&](int segment) -> const StraightPiece& {
    return grid.piece(segment);
  };
  each_nearest(grid, there, reach, own, x, found);
}

}  // namespace tress::models
