#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "models/contact/segment_grid.h"
#include "tests/models/effects/polylines.h"

namespace tress::test_segment_grid {

using namespace models;

using namespace testing_support;

constexpr double reach = 6e-3;

std::vector<int> segments_near(const SegmentGrid& grid, const Vec& x) {
  std::vector<int> all;
  for (const SegmentGrid::Entry& entry : grid.near(x)) {
    EXPECT_EQ(entry.polyline, grid.polyline(entry.segment));
    all.push_back(entry.segment);
  }
  return all;
}

TEST(SegmentGrid, MissesNoSegmentOfMovingStrands) {
  constexpr int steps = 60;
  constexpr double h = 1e-3;
  Polylines strands(30, 8, 0.08, 0.01, 1, 3);
  SegmentGrid grid(strands.points, reach);
  long found = 0;
  for (int step = 0; step < steps; ++step) {
    grid.update(strands.x);
    for (int i = 0; i < 300; ++i) {
      const Vec x = 0.1 * strands.random_vec();
      const std::vector<int> near = segments_near(grid, x);
      ASSERT_TRUE(std::ranges::is_sorted(near));
      for (int k = 0; k < static_cast<int>(grid.segments()); ++k) {
        const StraightPiece& piece = grid.piece(k);
        const Vec gap = x - piece.at(piece.nearest(x));
        if (dot(gap, gap) > reach * reach) continue;
        ++found;
        ASSERT_TRUE(std::ranges::binary_search(near, k));
      }
    }
    strands.move(h);
  }
  EXPECT_GT(found, 1000);
  // Cells stand while the fastest point has moved no more than half the reach.
  double fastest = 0;
  for (std::size_t i = 0; i < strands.v.size(); i += 3) {
    const Vec v = load3(&strands.v[i]);
    fastest = std::max(fastest, norm(v));
  }
  const int stand = static_cast<int>(reach / 2 / (fastest * h)) + 1;
  EXPECT_GT(stand, 1);
  EXPECT_EQ(grid.fillings(), 1 + (steps - 1) / stand);
}

TEST(SegmentGrid, FindsLongSegmentsAndThoseOfOnePoint) {
  const std::vector<double> x{0, 0, 0, 0.3, 0.2, 0.1, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5};
  SegmentGrid grid(std::vector<int>{2, 2}, reach);
  grid.update(x);
  for (double s = 0; s <= 1; s += 1e-3) {
    EXPECT_EQ(std::ranges::count(segments_near(grid, grid.piece(0).at(s)), 0), 1);
  }
  EXPECT_EQ(std::ranges::count(segments_near(grid, {0.5, 0.5, 0.505}), 1), 1);
}

TEST(SegmentGrid, TestsFewCandidatesHoweverManySegments) {
  // The same density: candidates per point stay, and so do entries per segment.
  for (const int strands : {30, 240}) {
    Polylines few(strands, 10, 0.06 * std::cbrt(strands / 30.0), 0.01, 1, 5);
    SegmentGrid grid(few.points, reach);
    grid.update(few.x);
    std::size_t candidates = 0, close = 0;
    for (std::size_t i = 0; i < few.x.size(); i += 3) {
      const Vec x = load3(&few.x[i]);
      for (const int k : segments_near(grid, x)) {
        ++candidates;
        const Vec gap = x - grid.piece(k).at(grid.piece(k).nearest(x));
        if (dot(gap, gap) <= reach * reach) ++close;
      }
    }
    // Close by chance: the volume pi reach^2 (l + 4/3 reach) about a segment, 2e-6 m^3.
    // A cell's catch: 1.5 reach and up to half of the cell's diagonal, 2.1 reach
    // sqrt(3)/2, farther: 3.3 reach, 3.3^2 (l + 4.4 reach)/(l + 1.3 reach) = 22 times
    // that; besides what shares a bucket by chance.
    EXPECT_LE(candidates, 22 * close);
    // The same catch over the volume of a cell: 4.5e-5/(12.6e-3)^3 = 23.
    EXPECT_LE(grid.entries(), 23 * grid.segments());
  }
}

TEST(SegmentGrid, SurvivesPlacesThatAreNoPlaces) {
  const double inf = std::numeric_limits<double>::infinity();
  SegmentGrid grid(std::vector<int>{2, 2, 2}, reach);
  for (const double far : {1e3, 1e30, 1e300, inf, std::nan("")}) {
    const std::vector<double> x{0, 0, 0,   0.01, 0,   0,   0.005, 0.001, 0,
                                0, 0, far, far,  far, far, -far,  far,   0};
    grid.update(x);
    EXPECT_GE(std::ranges::count(segments_near(grid, {0.005, 0, 0}), 0), 1);
    EXPECT_LE(grid.near({far, far, far}).size(), grid.entries());
    EXPECT_LE(grid.entries(), 100000);
  }
}

}  // namespace tress::test_segment_grid
