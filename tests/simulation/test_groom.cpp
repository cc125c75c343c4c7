#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "simulation/groom/cap.h"
#include "simulation/scene/scene.h"

namespace tress::test_groom {

using namespace simulation;

using std::numbers::pi;

std::vector<Strand> groomed(const std::string& keys, int seed = 1) {
  const std::string text =
      "title = \"t\"\nseed = " + std::to_string(seed) + "\n[groom]\n" + keys;
  return parse_scene(text, "t.toml").strands;
}

/// 2 pi a^2 (1 + c/(a e) asin e), e^2 = 1 - a^2/c^2, of a spheroid with c > a. The
/// midpoint rule over 256 rings is off by some (pi/256)^2/24 = 6e-6.
TEST(Cap, HasTheAreaOfASpheroid) {
  const double a = 0.1, c = 0.2, e = std::sqrt(1 - a * a / (c * c));
  const double area = 2 * pi * a * a * (1 + c / (a * e) * std::asin(e));
  EXPECT_NEAR(Cap({}, {a, a, c}, {0, 0, 1}, pi).area(), area, 1e-5 * area);
  EXPECT_NEAR(Cap({}, {a, a, c}, {1, 0, 0}, pi).area(), area, 1e-5 * area);
}

TEST(Groom, PutsRootsOnTheHeadWithinTheHairline) {
  for (const Strand& strand : groomed("centre_m = [1, 2, 3]\ncount = 300\n")) {
    const Vec x = strand.root.position - Vec{1, 2, 3};
    const Vec u{x.x / 0.1, x.y / 0.08, x.z / 0.12};
    EXPECT_NEAR(norm(u), 1, 1e-13);
    EXPECT_GE(dot(u, Vec{-0.4, 0, 1}) / std::hypot(0.4, 1), std::cos(1.3) - 1e-12);
  }
}

/// On a sphere area goes with the cosine of the polar angle, in which the roots are
/// equally spaced.
TEST(Groom, GivesEqualAreasEqualNumbersOfRoots) {
  constexpr int count = 400;
  const auto strands = groomed(
      "half_axes_m = [0.1, 0.1, 0.1]\ncap_axis = [0, 0, 1]\ncap_angle_rad = "
      "1.5707963267948966\ncount = 400\n");
  for (const double share : {0.1, 0.35, 0.8}) {
    const auto inside = std::ranges::count_if(
        strands, [&](const Strand& s) { return s.root.position.z >= 0.1 * (1 - share); });
    EXPECT_NEAR(static_cast<double>(inside) / count, share, 1.5 / count);
  }
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < strands.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      nearest =
          std::min(nearest, norm(strands[i].root.position - strands[j].root.position));
    }
  }
  // Side of the square that a root has to itself.
  EXPECT_GT(nearest, 0.5 * std::sqrt(2 * pi * 0.01 / count));
}

TEST(Groom, CountsByDensity) {
  const double area = Cap({}, {0.1, 0.1, 0.1}, {0, 0, 1}, pi / 2).area();
  const auto strands = groomed(
      "half_axes_m = [0.1, 0.1, 0.1]\ncap_axis = [0, 0, 1]\ncap_angle_rad = "
      "1.5707963267948966\ncount = 0\ndensity_per_m2 = 2000\n");
  EXPECT_EQ(strands.size(), static_cast<std::size_t>(2000 * area));
}

TEST(Groom, VariesLengthsAroundTheMeanAndRepeatsItself) {
  const std::string keys = "count = 50\nlength_m = 0.2\nlength_variation = 0.25\n";
  const auto strands = groomed(keys), again = groomed(keys), other = groomed(keys, 2);
  double least = 1, most = 0;
  int differ = 0;
  for (std::size_t i = 0; i < strands.size(); ++i) {
    const double length = strands[i].length();
    least = std::min(least, length);
    most = std::max(most, length);
    EXPECT_EQ(again[i].length(), length);
    EXPECT_EQ(again[i].root.frame.e1.x, strands[i].root.frame.e1.x);
    differ += other[i].length() != length ? 1 : 0;
  }
  EXPECT_GE(least, 0.15);
  EXPECT_LE(most, 0.25);
  EXPECT_GT(most - least, 0.05);
  EXPECT_EQ(differ, 50);
}

TEST(Groom, CombsDownAndAwayFromTheParting) {
  const auto plain = groomed("count = 100\ntilt_rad = 0\n");
  const auto down = groomed("count = 100\ntilt_rad = 1\n");
  const auto parted = groomed("count = 100\ntilt_rad = 1\nparting = 2\n");
  for (std::size_t i = 0; i < plain.size(); ++i) {
    const Vec x = plain[i].root.position;
    const Vec normal{x.x / 0.01, x.y / 0.0064, x.z / 0.0144};
    EXPECT_NEAR(dot(plain[i].root.frame.e0, normal) / norm(normal), 1, 1e-12);
    EXPECT_NEAR(dot(down[i].root.frame.e0, normal) / norm(normal), std::cos(1.0), 1e-12);
    EXPECT_LT(down[i].root.frame.e0.z, plain[i].root.frame.e0.z);
    if (x.y == 0) continue;  // on the parting, combed straight down
    const double side = std::copysign(1.0, x.y);
    EXPECT_GT(side * parted[i].root.frame.e0.y, side * down[i].root.frame.e0.y);
  }
}

}  // namespace tress::test_groom
