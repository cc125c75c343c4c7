// Neighbours, links and strips of guides; and what finds points near triangles.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "math/closest.h"
#include "models/contact/guide_mesh.h"
#include "models/contact/point_grid.h"

namespace tress::test_guide_mesh {

using namespace models;

using testing::ElementsAre;
using testing::Pair;

struct RandomPoints {
  std::mt19937 random{5};
  double uniform(double from = -1, double to = 1) {
    return std::uniform_real_distribution<double>(from, to)(random);
  }
  Vec vec() { return {uniform(), uniform(), uniform()}; }
};

TEST(Neighbours, OfASquareAreItsSidesAndOfAHexagonItsSpokesAndSides) {
  const std::vector<Vec> square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  EXPECT_THAT(neighbouring_roots(square, 2),
              ElementsAre(Pair(0, 1), Pair(0, 3), Pair(1, 2), Pair(2, 3)));
  std::vector<Vec> wheel{{0, 0, 0}};
  for (int i = 0; i < 6; ++i)
    wheel.push_back({std::cos(i * M_PI / 3), std::sin(i * M_PI / 3), 0});
  EXPECT_EQ(neighbouring_roots(wheel, 2).size(), 12U);
  EXPECT_EQ(neighbouring_roots(wheel, 0.9).size(), 0U);
}

TEST(Neighbours, HaveNoThirdRootBetweenThemAndJoinAllThatAreNear) {
  RandomPoints draw;
  std::vector<Vec> roots;
  for (int i = 0; i < 150; ++i) {
    const Vec at = draw.vec();
    roots.push_back((1 / norm(at)) * at);
  }
  const double width = 0.7;
  const auto pairs = neighbouring_roots(roots, width);
  const std::set<std::pair<int, int>> found(pairs.begin(), pairs.end());
  EXPECT_EQ(found.size(), pairs.size());
  for (int i = 0; i < 150; ++i) {
    for (int j = i + 1; j < 150; ++j) {
      const Vec a = roots[static_cast<std::size_t>(i)],
                b = roots[static_cast<std::size_t>(j)];
      const Vec centre = 0.5 * (a + b);
      const double radius = norm(a - b) / 2;
      bool empty = norm(a - b) <= width;
      for (int k = 0; k < 150; ++k) {
        if (k == i || k == j) continue;
        // No root lies this near to a sphere of those drawn.
        empty = empty &&
                norm(roots[static_cast<std::size_t>(k)] - centre) > radius * (1 + 1e-9);
      }
      EXPECT_EQ(found.contains({i, j}), empty) << i << ' ' << j;
    }
  }
  // A planar graph of 150 nodes has 3 x 150 - 6 edges at most; a tree has 149.
  EXPECT_GE(pairs.size(), 149U);
  EXPECT_LE(pairs.size(), 444U);
}

/// Straight strands along z with equal segments, roots in a row along x.
std::vector<double> row(const std::vector<int>& segments, double spacing, double length) {
  std::vector<double> x;
  for (std::size_t k = 0; k < segments.size(); ++k) {
    for (int i = 0; i <= segments[k]; ++i) {
      x.insert(x.end(), {spacing * static_cast<double>(k), 0, length * i / segments[k]});
    }
  }
  return x;
}

TEST(GuideMesh, LinksInnerPointsToTheNearestOnesAndCarriesAllOfTheirLength) {
  const std::vector<std::vector<double>> segments{{1, 1, 1, 1}, {1, 1, 1, 1}, {2, 2}};
  const GuideMesh mesh(segments, row({4, 4, 2}, 0.5, 4), 0.6);
  EXPECT_THAT(mesh.strips, ElementsAre(Pair(0, 1), Pair(1, 2)));
  double first = 0, second = 0;
  for (const GuideMesh::Link& link : mesh.links) {
    (link.second < 10 ? first : second) += link.carried;
    EXPECT_EQ(link.apart, 0.5);
  }
  // Three inner points of 1 m in each of the first two; the third has one of 2 m, which
  // is as far along as the second's middle, and from the others farther than the width.
  EXPECT_EQ(mesh.links.size(), 4U);
  EXPECT_EQ(first, 3);
  EXPECT_EQ(second, 1.5);
}

TEST(GuideMesh, StripsCoverWhatIsBetweenGuidesHoweverTheseAreCut) {
  for (const auto& cut : {std::vector{4, 4}, std::vector{5, 3}, std::vector{2, 7}}) {
    std::vector<std::vector<double>> segments;
    for (const int n : cut) segments.emplace_back(static_cast<std::size_t>(n), 2.0 / n);
    const std::vector<double> x = row(cut, 0.5, 2);
    const GuideMesh mesh(segments, x, 0.6);
    double area = 0;
    for (const GuideMesh::Triangle& one : mesh.triangles) {
      const auto at = [&](std::size_t c) {
        return load3(&x[3 * static_cast<std::size_t>(one.corner[c])]);
      };
      area += norm(cross(at(1) - at(0), at(2) - at(0))) / 2;
      EXPECT_EQ(mesh.strand[static_cast<std::size_t>(one.corner[0])],
                mesh.strand[static_cast<std::size_t>(one.corner[1])]);
      EXPECT_EQ(one.width, width_of(one, x));
    }
    EXPECT_EQ(mesh.triangles.size(), static_cast<std::size_t>(cut[0] + cut[1]));
    EXPECT_NEAR(area, 1, 1e-14);  // no overlap: sums of 9 areas at most
  }
}

TEST(Triangle, NearestPlaceIsNoFartherThanAnyOther) {
  RandomPoints draw;
  for (int n = 0; n < 300; ++n) {
    const std::array<Vec, 3> corner{draw.vec(), draw.vec(), draw.vec()};
    const Vec x = 2 * draw.vec();
    const auto w = nearest(corner, x);
    EXPECT_NEAR(w[0] + w[1] + w[2], 1, 1e-15);
    for (const double one : w) EXPECT_GE(one, 0);
    const auto square = [&](double a, double b, double c) {
      const Vec d = x - a * corner[0] - b * corner[1] - c * corner[2];
      return dot(d, d);
    };
    const double least = square(w[0], w[1], w[2]);
    for (int i = 0; i <= 20; ++i) {
      for (int j = 0; i + j <= 20; ++j) {
        EXPECT_LE(least, square(i / 20.0, j / 20.0, (20 - i - j) / 20.0) * (1 + 1e-12));
      }
    }
  }
  // Without area.
  const auto w =
      nearest(std::array<Vec, 3>{Vec{0, 0, 0}, Vec{1, 0, 0}, Vec{2, 0, 0}}, {1.5, 1, 0});
  EXPECT_EQ(w[1] + 2 * w[2], 1.5);
}

TEST(PointGrid, FindsThePointsOfABoxOnceEach) {
  RandomPoints draw;
  std::vector<double> x;
  for (int i = 0; i < 500; ++i) {
    const Vec at = draw.vec();
    x.insert(x.end(), {at.x, at.y, at.z});
  }
  x[30] = std::nan("");
  PointGrid grid;
  for (const double cell : {0.05, 0.3, 5.0}) {
    grid.fill(x, cell);
    for (int n = 0; n < 50; ++n) {
      const Vec at = draw.vec();
      Box box{at, at};
      box.include(at + 0.4 * draw.vec());
      std::vector<int> found, expected;
      grid.each_in(box, [&](int point) { found.push_back(point); });
      for (int i = 0; i < 500; ++i) {
        const Vec p = load3(&x[3 * static_cast<std::size_t>(i)]);
        if (p.x >= box.least.x && p.x <= box.most.x && p.y >= box.least.y &&
            p.y <= box.most.y && p.z >= box.least.z && p.z <= box.most.z) {
          expected.push_back(i);
        }
      }
      std::ranges::sort(found);
      EXPECT_EQ(found, expected);
    }
  }
}

}  // namespace tress::test_guide_mesh
