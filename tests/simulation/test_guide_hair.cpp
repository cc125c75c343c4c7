#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "contract/input_error.h"
#include "simulation/export/guide_hair.h"

namespace tress::test_guide_hair {

using namespace simulation;

constexpr std::size_t points = 11;
constexpr double eps = std::numeric_limits<double>::epsilon();

double apart(const Vec& a, const Vec& b) { return norm(a - b); }

/// Guides that hang in curls from random places of a patch of 10 cm x 10 cm.
struct Groom {
  explicit Groom(std::size_t guides, unsigned seed = 3) {
    std::mt19937 random(seed);
    const auto between = [&](double low, double high) {
      return low + (high - low) * static_cast<double>(random()) * 0x1p-32;
    };
    for (std::size_t g = 0; g < guides; ++g) {
      roots.push_back({between(-0.05, 0.05), between(-0.05, 0.05), 0});
      const double phase = between(0, 6), radius = between(0.002, 0.006);
      for (std::size_t i = 0; i < points; ++i) {
        const double s = static_cast<double>(i) / (points - 1);
        guide_points.push_back(
            roots.back() + Vec{radius * s * std::cos(9 * s + phase),
                               0.06 * s * s + radius * s * std::sin(9 * s), -0.15 * s});
      }
    }
    for (int h = 0; h < 200; ++h) {
      hair_roots.push_back({between(-0.05, 0.05), between(-0.05, 0.05), 0});
    }
  }
  std::vector<Vec> hair(const GuideHairOptions& options, const Frame& head = {}) const {
    std::vector<Vec> out(hair_roots.size() * points);
    GuideHair(roots, hair_roots, points, options).grow(guide_points, head, out);
    return out;
  }

  std::vector<Vec> roots, hair_roots, guide_points;
};

TEST(GuideHair, AtAGuidesRootIsThatGuide) {
  Groom groom(12);
  groom.hair_roots = groom.roots;
  for (const double clumpiness : {0.0, 0.3, 1.0}) {
    const auto hair = groom.hair({.clumpiness = clumpiness});
    for (std::size_t i = 0; i < hair.size(); ++i) {
      // Two sums and one blend of numbers below 1 m: five roundings of at most eps / 2
      // each in every component.
      EXPECT_LT(apart(hair[i], groom.guide_points[i]), 5 * eps);
    }
  }
}

/// Hair of any shape is itself where the guides are where its shape was told, and is
/// carried rigidly by guides that move so; one at a guide's root is still that guide.
TEST(GuideHair, KeepsShapesOfItsOwn) {
  Groom groom(12);
  std::mt19937 random(9);
  const Frame tilt = rotation({0.6, 0, 0.8}, 0.7);
  const Vec shift{0.2, -0.1, 0.3};
  groom.hair_roots.insert(groom.hair_roots.end(), groom.roots.begin(), groom.roots.end());
  std::vector<Vec> own;
  for (const Vec& root : groom.hair_roots) {
    const bool guide = own.size() >= 200 * points;
    for (std::size_t i = 0; i < points; ++i) {
      if (guide) {
        own.push_back(groom.guide_points[own.size() - 200 * points]);
      } else {
        const double s = static_cast<double>(i) / (points - 1);
        own.push_back(root + s * Vec{static_cast<double>(random()) * 1e-11, 0.02, -0.2});
      }
    }
  }
  GuideHair hair(groom.roots, groom.hair_roots, points, {.clumpiness = 0});
  hair.keep_shapes(groom.guide_points, {}, own);
  std::vector<Vec> grown(own.size());
  hair.grow(groom.guide_points, {}, grown);
  // Sums of numbers below 0.3 m and a rotation forth and back.
  for (std::size_t i = 0; i < own.size(); ++i)
    EXPECT_LT(apart(grown[i], own[i]), 10 * eps);
  std::vector<Vec> moved;
  for (const Vec& x : groom.guide_points) moved.push_back(shift + tilt * x);
  hair.grow(moved, tilt, grown);
  for (std::size_t i = 0; i < own.size(); ++i) {
    EXPECT_LT(apart(grown[i], shift + tilt * own[i]), 100 * eps);
  }
}

TEST(GuideHair, WeightsSumToOneAndTheNearestHasMost) {
  for (const std::size_t guides : {1, 2, 3, 4, 30}) {
    const Groom groom(guides);
    const GuideHair hair(groom.roots, groom.hair_roots, points, {});
    ASSERT_EQ(hair.hairs(), 200);
    for (std::size_t h = 0; h < hair.hairs(); ++h) {
      const auto& [guide, weight] = hair.neighbours(h);
      EXPECT_NEAR(std::accumulate(weight.begin(), weight.end(), 0.0), 1, 3 * eps);
      double best = 1;
      for (const Vec& root : groom.roots) {
        best = std::min(best, apart(root, groom.hair_roots[h]));
      }
      EXPECT_EQ(apart(groom.roots[guide[0]], groom.hair_roots[h]), best);
      for (const double w : weight) {
        EXPECT_GE(w, 0);
        EXPECT_LE(w, weight[0]);
      }
    }
  }
}

// Four guides at the corners of a square: all as far from its middle, so that each
// counted one has the weight 1/3; nothing divides by zero.
TEST(GuideHair, EquallyFarGuidesShareAlike) {
  const std::vector<Vec> corners{{1, 1, 0}, {-1, 1, 0}, {-1, -1, 0}, {1, -1, 0}};
  const GuideHair hair(corners, {{0, 0, 0}}, 2, {});
  EXPECT_THAT(hair.neighbours(0).weight, testing::Each(testing::DoubleEq(1.0 / 3)));
}

// What varies linearly over the roots. On a square lattice of spacing a the three nearest
// roots make a right angle: the smaller eigenvalue of the edges' products is 0.38 a^2 at
// least, l^2 = 2 a^2 at most, so that 3 e l^2 of a distance below a/sqrt(2) is left of
// 0.38 a^2: 1.2 % of a. Weights that fall with distance alone leave far more.
TEST(GuideHair, LinearWeightsReproduceLinearFields) {
  constexpr double a = 0.01;
  std::vector<Vec> roots, hairs;
  std::mt19937 random(5);
  const auto share = [&random] { return static_cast<double>(random()) * 0x1p-32 - 0.5; };
  for (int i = 0; i < 8; ++i) {
    for (int j = 0; j < 8; ++j) {
      roots.push_back({a * i, a * j, 0});
      // Within the square of every root that has neighbours on all sides.
      if (i % 7 == 0 || j % 7 == 0) continue;
      hairs.push_back({a * (i + 0.9 * share()), a * (j + 0.9 * share()), 0});
    }
  }
  const auto largest = [&](bool linear) {
    const GuideHair hair(roots, hairs, 2, {.clumpiness = 0, .linear = linear});
    double most = 0;
    for (std::size_t h = 0; h < hairs.size(); ++h) {
      const auto& [guide, weight] = hair.neighbours(h);
      EXPECT_NEAR(std::accumulate(weight.begin(), weight.end(), 0.0), 1, 10 * eps);
      Vec mean;
      for (std::size_t k = 0; k < 3; ++k) mean = mean + weight[k] * roots[guide[k]];
      most = std::max(most, apart(mean, hairs[h]));
    }
    return most;
  };
  EXPECT_LT(largest(true), 0.012 * a);
  EXPECT_GT(largest(false), 0.2 * a);
}

// Guides on a line say nothing across it: weights stay what they were there. So do those
// of one guide, and of guides in one place.
TEST(GuideHair, LinearWeightsBearDegenerateGuides) {
  const std::vector<Vec> line{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, one{{0, 0, 0}},
      same{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  for (const auto& roots : {line, one, same}) {
    const GuideHair hair(roots, {{0.3, 0.5, 0}}, 2, {.clumpiness = 0, .linear = true});
    const auto& weight = hair.neighbours(0).weight;
    EXPECT_NEAR(weight[0] + weight[1] + weight[2], 1, 10 * eps);
    if (roots.size() < 3 || apart(roots[1], roots[0]) == 0) continue;
    // e l^2 = 4e-3 against edges' products of 1 and more.
    EXPECT_NEAR(weight[1] + 2 * weight[2], 0.3, 0.02);
  }
}

// A root that walks over the scalp: without clumps its hair moves by no jump, also where
// one of the three guides is exchanged. 2e5 steps of 5e-7 m; were a weight to jump by
// 1e-3 between guides whose ends are 1 cm apart, the tip would jump by 1e-5 m, against
// the largest step found.
TEST(GuideHair, IsContinuousOverTheScalp) {
  Groom groom(15);
  groom.hair_roots.clear();
  constexpr int steps = 200000;
  for (int i = 0; i <= steps; ++i) {
    groom.hair_roots.push_back({-0.05 + 0.1 * i / steps, 0.01, 0});
  }
  const GuideHairOptions options{.clumpiness = 0, .tip_limit = 10};
  const auto hair = groom.hair(options);
  double largest = 0;
  for (std::size_t h = 1; h < groom.hair_roots.size(); ++h) {
    largest = std::max(largest, apart(hair[(h + 1) * points - 1], hair[h * points - 1]));
  }
  EXPECT_LT(largest, 1e-5);
}

// Everything turned and moved: sums of a dozen terms below 1 m, each carried through
// rotations, 1e-12 leaves three digits over the rounding.
TEST(GuideHair, MovesRigidlyWithItsGuides) {
  const Groom still(20);
  Groom moved = still;
  const double third = 1 / std::sqrt(3.0);
  const Frame turn = rotation({third, -third, third}, 1.9);
  const Vec shift{0.4, -0.7, 0.2};
  for (Vec& x : moved.guide_points) x = shift + turn * x;
  for (const double clumpiness : {0.0, 0.5, 1.0}) {
    const GuideHairOptions options{.clumpiness = clumpiness, .tip_limit = 0.05};
    const auto before = still.hair(options);
    const auto after = moved.hair(options, turn);
    for (std::size_t i = 0; i < before.size(); ++i) {
      EXPECT_LT(apart(after[i], shift + turn * before[i]), 1e-12);
    }
  }
}

// Two groups with one scalp, combed to both sides: the groups' tips are 20 cm apart, the
// limit is 5 cm. Tips of hairs stay within the tips of one group, in x by the width of
// the locks (at most the 5 cm from a root to its guide's).
TEST(GuideHair, LeavesAPartingFree) {
  Groom groom(40);
  for (std::size_t g = 0; g < groom.roots.size(); ++g) {
    const double side = groom.roots[g].x < 0 ? -1 : 1;
    for (std::size_t i = 0; i < points; ++i) {
      const double s = static_cast<double>(i) / (points - 1);
      groom.guide_points[g * points + i] =
          groom.roots[g] + Vec{side * 0.15 * s, 0, -0.1 * s * s};
    }
  }
  const auto nearest_tip = [&](const GuideHairOptions& options) {
    const auto hair = groom.hair(options);
    double least = 1;
    for (std::size_t h = 0; h < groom.hair_roots.size(); ++h) {
      least = std::min(least, std::abs(hair[(h + 1) * points - 1].x));
    }
    return least;
  };
  for (const double clumpiness : {0.0, 0.5, 1.0}) {
    EXPECT_GT(nearest_tip({.clumpiness = clumpiness, .tip_limit = 0.05}), 0.1);
  }
  // And would not, if it were not for the limit.
  EXPECT_LT(nearest_tip({.clumpiness = 0, .tip_limit = 10}), 0.05);
}

// Two guides that swing apart by `step` each, one hair between them, nearer to the first.
// Of the way D between the tips it has the share f = a q/(1 + a q) with a <= 1, and q
// falls from 1 to 0 with |dq/dD| <= (3/2)(2/limit). While q > 0, D < limit, and the tip
// moves by at most step + D |df/dD| 2 step <= step + 3 * 2 step = 7 step.
TEST(GuideHair, LeavesAGuideWithoutAJump) {
  const std::vector<Vec> roots{{-0.01, 0, 0}, {0.01, 0, 0}};
  const GuideHair hair(roots, {{-0.001, 0, 0}}, 2, {.clumpiness = 0, .tip_limit = 0.05});
  const auto tip = [&](double spread) {
    const std::vector<Vec> guides{roots[0], roots[0] + Vec{-spread, 0, -0.1}, roots[1],
                                  roots[1] + Vec{spread, 0, -0.1}};
    std::vector<Vec> out(2);
    hair.grow(guides, {}, out);
    return out[1].x;
  };
  const double step = 1e-5;
  for (double spread = 0; spread < 0.06; spread += step) {
    EXPECT_LT(std::abs(tip(spread + step) - tip(spread)), 7 * step);
  }
  // Beyond the limit the hair follows its own guide alone.
  EXPECT_NEAR(tip(0.05), -0.051, 1e-15);
  EXPECT_GT(tip(0.01), -0.0095);
}

// At clumpiness 1 a lock is tip_width as wide at its end as at its root, whatever way it
// is bent: the cross-section is carried, not squeezed.
TEST(GuideHair, LocksCloseTowardsTheTip) {
  const Groom groom(12);
  const GuideHairOptions options{.clumpiness = 1, .tip_width = 0.25};
  const GuideHair hair(groom.roots, groom.hair_roots, points, options);
  const auto grown = groom.hair(options);
  for (std::size_t h = 0; h < hair.hairs(); ++h) {
    const std::size_t own = hair.neighbours(h).guide[0];
    const double root = apart(groom.hair_roots[h], groom.roots[own]);
    for (std::size_t i = 0; i < points; ++i) {
      const double s = static_cast<double>(i) / (points - 1);
      EXPECT_NEAR(apart(grown[h * points + i], groom.guide_points[own * points + i]),
                  (1 - 0.75 * s) * root, 1e-14);
    }
  }
}

// Less clumpy hair stays farther from the guides at the tips, and starts at its own root.
TEST(GuideHair, ClumpinessGoesFromSmoothToLocks) {
  const Groom groom(12);
  double before = 0;
  for (const double clumpiness : {1.0, 0.7, 0.3, 0.0}) {
    const GuideHairOptions options{.clumpiness = clumpiness, .tip_limit = 10};
    const GuideHair hair(groom.roots, groom.hair_roots, points, options);
    const auto grown = groom.hair(options);
    double mean = 0;
    for (std::size_t h = 0; h < hair.hairs(); ++h) {
      const std::size_t tip = hair.neighbours(h).guide[0] * points + points - 1;
      mean += apart(grown[(h + 1) * points - 1], groom.guide_points[tip]) / 200;
      EXPECT_LT(apart(grown[h * points], groom.hair_roots[h]), 5 * eps);
    }
    EXPECT_GT(mean, before);
    before = mean;
  }
}

TEST(GuideHair, IsTheSameForTheSameSeedAndOthersForAnother) {
  const Groom groom(12);
  const auto same = [](const std::vector<Vec>& a, const std::vector<Vec>& b) {
    for (std::size_t i = 0; i < a.size(); ++i) {
      if (a[i].x != b[i].x || a[i].y != b[i].y || a[i].z != b[i].z) return false;
    }
    return true;
  };
  const auto first = groom.hair({.seed = 5});
  EXPECT_TRUE(same(first, groom.hair({.seed = 5})));
  EXPECT_FALSE(same(first, groom.hair({.seed = 6})));
  // A hair does not depend on how many come after it.
  Groom fewer = groom;
  fewer.hair_roots.resize(50);
  EXPECT_TRUE(same(fewer.hair({.seed = 5}), first));
}

// Guides on a sphere of radius 10 cm: hair stays between them, so not above the sphere,
// and below by no more than the header says; every guide has its part of it.
TEST(ScatterRoots, LieBetweenTheGuides) {
  std::vector<Vec> guides;
  for (int g = 0; g < 200; ++g) {
    const double z = 1 - (g + 0.5) / 200, a = 2.399963 * g, w = std::sqrt(1 - z * z);
    guides.push_back(0.1 * Vec{w * std::cos(a), w * std::sin(a), z});
  }
  const auto roots = scatter_roots(guides, 3000, 4);
  ASSERT_EQ(roots.size(), 3000);
  // Two of the four nearest are no farther apart than twice the way to the fourth.
  double edge = 0;
  for (const Vec& guide : guides) {
    std::vector<double> distance(guides.size());
    std::ranges::transform(guides, distance.begin(),
                           [&](const Vec& other) { return apart(guide, other); });
    std::ranges::nth_element(distance, distance.begin() + 4);
    edge = std::max(edge, 2 * distance[4]);
  }
  std::vector<int> own(guides.size());
  const GuideHair hair(guides, roots, 2, {});
  for (std::size_t h = 0; h < roots.size(); ++h) {
    EXPECT_LE(norm(roots[h]), 0.1 * (1 + 2 * eps));
    EXPECT_GE(norm(roots[h]), 0.1 - edge * edge / 0.6);
    ++own[hair.neighbours(h).guide[0]];
  }
  EXPECT_THAT(own, testing::Each(testing::Gt(0)));
  const auto fewer = scatter_roots(guides, 100, 4), other = scatter_roots(guides, 100, 5);
  for (std::size_t h = 0; h < fewer.size(); ++h) {
    EXPECT_EQ(apart(fewer[h], roots[h]), 0);
    EXPECT_GT(apart(fewer[h], other[h]), 0);
  }
}

TEST(ScatterRoots, OfOneGuideAreItsOwnAndOfTwoLieBetween) {
  const std::vector<Vec> two{{0, 0, 0}, {1, 0, 0}};
  for (const Vec& root : scatter_roots(std::span(two).first(1), 5, 1)) {
    EXPECT_EQ(norm(root), 0);
  }
  for (const Vec& root : scatter_roots(two, 100, 1)) {
    EXPECT_GE(root.x, 0);
    EXPECT_LE(root.x, 1);
    EXPECT_EQ(root.y, 0);
  }
  EXPECT_TRUE(scatter_roots({}, 5, 1).empty());
}

// Points that coincide and a strand folded onto itself have no tangent or no smallest
// rotation; the hair stays finite.
TEST(GuideHair, BearsDegenerateGuides) {
  const std::vector<Vec> guide{{0, 0, 0}, {0, 0, 0},  {0, 0, -1},
                               {0, 0, 0}, {0, 0, -1}, {0, 0, -1}};
  const GuideHair hair({{0, 0, 0}}, {{0.1, 0, 0}}, guide.size(), {.clumpiness = 1});
  std::vector<Vec> out(guide.size());
  hair.grow(guide, {}, out);
  for (const Vec& x : out) EXPECT_TRUE(is_finite(x));
}

TEST(GuideHair, RefusesWhatMakesNoSense) {
  const std::vector<Vec> root{{0, 0, 0}};
  const auto refused = [&](std::vector<Vec> guides, std::size_t n,
                           const GuideHairOptions& options) {
    EXPECT_THROW(GuideHair(std::move(guides), root, n, options), InputError);
  };
  refused({}, 3, {});
  refused(root, 1, {});
  refused({{std::nan(""), 0, 0}}, 3, {});
  refused(root, 3, {.clumpiness = 1.1});
  refused(root, 3, {.clumpiness = std::nan("")});
  refused(root, 3, {.tip_limit = 0});
  refused(root, 3, {.tip_width = -0.1});
  const GuideHair hair(root, root, 3, {});
  std::vector<Vec> right(3), wrong(4);
  EXPECT_THROW(hair.grow(wrong, {}, right), InputError);
  EXPECT_THROW(hair.grow(right, {}, wrong), InputError);
}

}  // namespace tress::test_guide_hair
