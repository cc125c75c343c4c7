// Where moving pieces touch: against the distance by search, and crossings of known time.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "models/contact/pieces/piece_approach.h"
#include "models/contact/pieces/piece_touch.h"
#include "tests/models/contact/random_contacts.h"

namespace tress::test_piece_touch {

using namespace models;
using test_contact::random_vec;

double least_distance(const StraightPiece& a, const StraightPiece& b) {
  double least = std::numeric_limits<double>::infinity();
  constexpr int parts = 400;
  for (int i = 0; i <= parts; ++i) {
    const Vec x = a.at(static_cast<double>(i) / parts);
    least = std::min(least, norm(x - b.at(b.nearest(x))));
  }
  return least;
}

TEST(NearestPoints, AreNoFartherApartThanAnyOthers) {
  std::mt19937 random(4);
  for (int i = 0; i < 2000; ++i) {
    const Vec x = random_vec(random), y = random_vec(random), z = random_vec(random);
    // Every fourth pair is parallel.
    const Vec end = i % 4 == 0 ? z + 0.7 * (y - x) : random_vec(random);
    const StraightPiece a(x, y), b(z, end);
    const NearestPoints near = nearest(a, b);
    const double distance = norm(a.at(near.of_first) - b.at(near.of_second));
    EXPECT_LE(distance, least_distance(a, b) + 1e-12) << i;
  }
}

/// A rod along y that moves through one along x from above to below, or towards it.
MovingPieces falling(double from, double to) {
  MovingPieces p;
  p.from = {Vec{0.3, -1, from}, Vec{0.3, 1, from}, Vec{0, 0, 0}, Vec{1, 0, 0}};
  p.to = {Vec{0.3, -1, to}, Vec{0.3, 1, to}, Vec{0, 0, 0}, Vec{1, 0, 0}};
  return p;
}

TEST(PieceTouch, OfPiecesThatPassThroughIsTheSideTheyCameFrom) {
  for (const double to : {-1e-9, -0.01, -5.0}) {
    const auto at = touch(falling(1, to), 1e-3);
    ASSERT_TRUE(at.has_value());
    EXPECT_NEAR(at->normal.z, 1, 1e-12) << to;
    EXPECT_NEAR(at->s, 0.5, 1e-9);
    EXPECT_NEAR(at->t, 0.3, 1e-9);
  }
}

TEST(PieceTouch, OfPiecesNearEachOtherIsTheirDirection) {
  EXPECT_FALSE(touch(falling(1, 0.01), 0.009).has_value());
  const auto at = touch(falling(1, 0.01), 0.011);
  ASSERT_TRUE(at.has_value());
  EXPECT_NEAR(at->normal.z, 1, 1e-12);
  EXPECT_FALSE(touch(falling(1, 2), 0.1).has_value());
}

TEST(PieceTouch, MissesNoRandomCrossing) {
  // Lines that meet at a given time and place, with random motions.
  std::mt19937 random(5);
  std::uniform_real_distribution<double> part(0.05, 0.95);
  for (int i = 0; i < 2000; ++i) {
    const double time = part(random), s = part(random), t = part(random);
    const Vec place = random_vec(random), along = random_vec(random),
              across = random_vec(random);
    const std::array<Vec, 4> meet{place - s * along, place + (1 - s) * along,
                                  place - t * across, place + (1 - t) * across};
    MovingPieces p;
    for (std::size_t a = 0; a < 4; ++a) {
      const Vec move = random_vec(random);
      p.from[a] = meet[a] - time * move;
      p.to[a] = meet[a] + (1 - time) * move;
    }
    const auto at = touch(p, 0);
    ASSERT_TRUE(at.has_value()) << i;
    // The side is that of the start, at the place where they meet first.
    const auto weights = at->weights();
    Vec start;
    for (std::size_t a = 0; a < 4; ++a) start = start + weights[a] * p.from[a];
    EXPECT_GE(dot(at->normal, start), 0) << i;
    EXPECT_NEAR(norm(at->normal), 1, 1e-12);
  }
}

TEST(PieceTouch, OfPiecesThatPassEachOthersEndsIsNone) {
  MovingPieces p = falling(1, -1);
  for (auto* x : {&p.from, &p.to}) {
    (*x)[0].x += 0.8;  // beyond the end of the other
    (*x)[1].x += 0.8;
  }
  EXPECT_FALSE(touch(p, 0.05).has_value());
}

/// The bound holds at all times, and is the distance where nothing moves; pieces of no
/// length and parallel ones are among them, and numbers of pairs that fill no lanes.
TEST(LeastApproaches, AreNoFartherThanPiecesComeInTheStep) {
  std::mt19937 random(11);
  for (int i = 0; i < 400; ++i) {
    const bool moves = i % 2 == 1;
    std::vector<std::array<Vec, 4>> ends;  // at the start and at the end of the step
    std::vector<PieceMotion> motion;
    for (int k = 0; k < 6; ++k) {
      const Vec x = random_vec(random);
      Vec y = random_vec(random);
      if (k == 1) y = x + 0.7 * (ends[0][1] - ends[0][0]);
      if (k == 2) y = x;
      const Vec by = moves ? 0.3 * random_vec(random) : Vec{},
                other = moves ? 0.3 * random_vec(random) : Vec{};
      ends.push_back({x, y, x + by, y + other});
      motion.emplace_back(x, x + by, y, y + other);
    }
    std::vector<BoxPairs::Pair> pairs;
    for (int k = 0; k < 1 + i % 7; ++k) pairs.push_back({k % 3, 3 + (k + i) % 3});
    least_approaches(motion, pairs);
    for (const auto& [first, second, least] : pairs) {
      const auto& a = ends[static_cast<std::size_t>(first)];
      const auto& b = ends[static_cast<std::size_t>(second)];
      for (const double part : {0.0, 0.2, 0.5, 0.9, 1.0}) {
        const auto at = [part](const Vec& from, const Vec& to) {
          return (1 - part) * from + part * to;
        };
        const double now =
            distance({at(a[0], a[2]), at(a[1], a[3]), at(b[0], b[2]), at(b[1], b[3])});
        EXPECT_LE(least, now + 1e-12) << i;
        if (!moves) {
          EXPECT_NEAR(least, now, 1e-12) << i;
        }
      }
    }
  }
}

/// Pieces that come nearer than a reach are apart by it along the normal at the start:
/// until then no two of their points are nearer, so that those that meet approach.
TEST(FirstTouch, IsOnTheSideThatPiecesComeFrom) {
  std::mt19937 random(9);
  int slipped = 0, seen = 0;
  for (int i = 0; i < 20000; ++i) {
    MovingPieces p;
    for (std::size_t end = 0; end < 4; ++end) {
      p.from[end] = 0.5 * random_vec(random);
      p.to[end] = p.from[end] + 0.3 * random_vec(random);
    }
    const double reach = 0.15;
    if (distance(p.from) < reach || distance(p.to) > reach) continue;
    ++seen;
    const auto along = [&](const PieceTouch& at) {
      Vec gap;
      for (std::size_t end = 0; end < 4; ++end) {
        gap = gap + at.weights()[end] * p.from[end];
      }
      return dot(gap, at.normal);
    };
    const auto at_end = touch(p, reach);
    ASSERT_TRUE(at_end);
    if (along(*at_end) < 0.5 * reach) ++slipped;
    // It stops as near as a thousandth.
    EXPECT_GE(along(first_touch(p, reach)), 0.98 * reach) << i;
  }
  EXPECT_GT(seen, 500);
  EXPECT_GT(slipped, 50);
}

}  // namespace tress::test_piece_touch
