#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "models/contact/local_drift.h"
#include "models/contact/rigid_motion.h"
#include "models/contact/segment_cells.h"
#include "tests/models/effects/polylines.h"

namespace tress::test_segment_cells {

using namespace models;
using namespace testing_support;

StraightPiece piece(const std::vector<double>& x, int segment) {
  const auto at = 3 * static_cast<std::size_t>(segment);
  return {load3(&x[at]), load3(&x[at + 3])};
}

/// Every segment within the radius is found, ascending and once; returns how many there
/// were and how many were found.
std::pair<long, long> check(const SegmentCells& cells, const std::vector<double>& x,
                            const StraightPiece& own, double radius, int but) {
  std::vector<int> found;
  cells.near(own, radius, but, found);
  EXPECT_TRUE(std::ranges::is_sorted(found));
  EXPECT_EQ(std::ranges::adjacent_find(found), found.end());
  long close = 0;
  for (int i = 0; i < static_cast<int>(cells.points()); ++i) {
    const bool listed = std::ranges::binary_search(found, i);
    if (cells.last(i) || cells.polyline(i) == but) {
      EXPECT_FALSE(listed);
      continue;
    }
    const StraightPiece other = piece(x, i);
    const NearestPoints at = nearest(own, other);
    const Vec gap = own.at(at.of_first) - other.at(at.of_second);
    if (!(dot(gap, gap) <= radius * radius)) continue;
    ++close;
    EXPECT_TRUE(listed) << i;
  }
  return {close, static_cast<long>(found.size())};
}

TEST(SegmentCells, MissNoSegmentDenseSparseStrayAndLong) {
  long close = 0;
  for (const double box : {0.03, 0.3}) {
    Polylines strands(40, 8, box, 0.01, 1, 3);
    // One strand is a kilometre away, one segment is 30 m long.
    for (std::size_t i = 0; i < 27; ++i) strands.x[i] += 1e3;
    strands.x[3 * 17] += 30;
    SegmentCells cells(strands.points);
    // Segments of 10 mm lie in cells as a whole, and in many parts.
    for (const auto& [reach, radius] : std::vector<std::pair<double, double>>{
             {9e-3, 2e-3}, {9e-3, 9e-3}, {9e-3, 0.05}, {4e-4, 4e-4}, {4e-4, 9e-3}}) {
      cells.fill(strands.x, reach, in_turn);
      EXPECT_EQ(cells.parts() > 5 * cells.points(), reach < 1e-3);
      for (int i = 0; i < static_cast<int>(cells.points()); ++i) {
        if (cells.last(i)) continue;
        close +=
            check(cells, strands.x, piece(strands.x, i), radius, cells.polyline(i)).first;
      }
    }
  }
  EXPECT_GT(close, 10000);
}

TEST(SegmentCells, FindFewHoweverManyThereAre) {
  for (const int strands : {60, 480}) {
    Polylines all(strands, 10, 0.06 * std::cbrt(strands / 30.0), 0.01, 1, 5);
    SegmentCells cells(all.points);
    cells.fill(all.x, 9e-3, in_turn);
    long close = 0, found = 0;
    for (int i = 0; i < static_cast<int>(cells.points()); ++i) {
      if (cells.last(i)) continue;
      const auto [one, listed] =
          check(cells, all.x, piece(all.x, i), 9e-3, cells.polyline(i));
      close += one;
      found += listed;
    }
    // Boxes of side 18 mm and half a segment in place of cylinders: less than four times.
    EXPECT_GT(close, 5 * strands);
    EXPECT_LT(found, 4 * close);
    // A part has 20 bytes, its cells at most 2 x 4, a segment one or two parts, itself as
    // a point 8.
    EXPECT_LT(cells.bytes(), 160 * cells.points() + 4096);
  }
}

TEST(SegmentCells, AreTheSameInAnyOrderOfWork) {
  const Polylines strands(3000, 8, 0.2, 0.01, 1, 3);
  SegmentCells one(strands.points), other(strands.points);
  one.fill(strands.x, 9e-3, in_turn);
  other.fill(strands.x, 9e-3,
             [](std::size_t count, const std::function<void(std::size_t)>& work) {
               for (std::size_t i = count; i-- > 0;) work(i);
             });
  std::vector<int> a, b;
  for (int i = 0; i + 1 < static_cast<int>(one.points()); i += 50) {
    if (one.last(i)) continue;
    one.near(piece(strands.x, i), 9e-3, one.polyline(i), a);
    other.near(piece(strands.x, i), 9e-3, one.polyline(i), b);
    EXPECT_EQ(a, b);
  }
}

TEST(SegmentCells, SurvivePlacesThatAreNone) {
  const double inf = std::numeric_limits<double>::infinity();
  SegmentCells cells(std::vector<int>{2, 2, 2});
  for (const double far : {1e3, 1e30, 1e300, inf, std::nan("")}) {
    const std::vector<double> x{0, 0, 0,   0.01, 0,   0,   0.005, 0.001, 0,
                                0, 0, far, far,  far, far, -far,  far,   0};
    cells.fill(x, 6e-3, in_turn);
    std::vector<int> found;
    cells.near({{0.005, 0, 0}, {0.005, 0.001, 0}}, 6e-3, 1, found);
    EXPECT_TRUE(std::ranges::binary_search(found, 0));
    cells.near({{far, far, far}, {far, far, 0}}, 6e-3, 1, found);
    EXPECT_LE(found.size(), 2U);
  }
}

TEST(LocalDrift, HoldsWhatMovesNearAPlaceAndLessThanAll) {
  const Polylines strands(200, 8, 0.3, 0.01, 1, 3);
  SegmentCells cells(strands.points);
  cells.fill(strands.x, 9e-3, in_turn);
  constexpr double sight = 0.02;
  LocalDrift drift;
  drift.fill(cells, strands.x, sight, in_turn);
  std::vector<Vec> by(cells.points());
  for (std::size_t i = 0; i < by.size(); ++i) {
    const Vec x = load3(&strands.x[3 * i]);
    by[i] = 1e-3 * Vec{std::sin(40 * x.x), std::cos(30 * x.y), x.z};
  }
  by[5].x = std::nan("");
  drift.move(cells, by, in_turn);
  // Rounding of displacements of a millimetre.
  const auto inside = [](const LocalDrift::Spread& all, const Vec& x) {
    return norm(x - all.middle) <= all.radius + 1e-18;
  };
  long near = 0, out = 0;
  for (std::size_t at = 0; at < by.size(); at += 40) {
    const Vec place = load3(&strands.x[3 * at]);
    const LocalDrift::Spread& all = drift.near(drift.cells(Vec3<Pack>(place))[0]);
    for (std::size_t i = 0; i < by.size(); ++i) {
      if (cells.last(static_cast<int>(i)) || !is_finite(by[i]) || !is_finite(by[i + 1])) {
        continue;
      }
      cells.each_part(i, strands.x, [&](std::size_t, const Vec& middle) {
        const Vec d = middle - place;
        const bool within =
            std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)}) < sight;
        near += within ? 1 : 0;
        EXPECT_TRUE(!within || (inside(all, by[i]) && inside(all, by[i + 1])));
        out += inside(all, by[i]) ? 0 : 1;
      });
    }
  }
  EXPECT_GT(near, 200);
  EXPECT_GT(out, 500);
  EXPECT_GT(drift.mean(), 0);
}

TEST(RigidMotion, IsFoundFromPointsThatMovedWithIt) {
  const Polylines strands(20, 1, 0.2, 0.01, 1, 3);
  const Frame turn = rotation({0.6, 0, 0.8}, 2.5);
  const Vec shift{0.3, -0.2, 5};
  std::vector<Vec> before, now;
  for (std::size_t i = 0; i < strands.x.size(); i += 3) {
    before.push_back(load3(&strands.x[i]));
    now.push_back(turn * before.back() + shift);
  }
  const RigidMotion found = rigid_motion(before, now);
  for (std::size_t i = 0; i < now.size(); ++i) {
    // Rounding of 5 m.
    EXPECT_LT(norm(found.back(now[i]) - before[i]), 1e-14);
  }
  // In a plane as well; on a line they do not determine it.
  const std::vector<Vec> flat{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}},
      turned{turn * flat[0], turn * flat[1], turn * flat[2]};
  const RigidMotion of_flat = rigid_motion(flat, turned);
  EXPECT_LT(norm(of_flat.back(turn * Vec{0, 0, 1}) - Vec{0, 0, 1}), 1e-14);
  const std::vector<Vec> line{{0, 0, 0}, {1, 0, 0}}, elsewhere{{0, 0, 1}, {0, 1, 1}};
  EXPECT_EQ(norm(rigid_motion(line, elsewhere).back(shift) - shift), 0);
  before.back().x = std::nan("");
  EXPECT_EQ(norm(rigid_motion(before, now).back(shift) - shift), 0);
}

}  // namespace tress::test_segment_cells
