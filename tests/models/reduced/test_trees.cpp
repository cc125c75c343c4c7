#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <ostream>
#include <string>

#include "contract/input_error.h"
#include "models/reduced/trees.h"
#include "tests/models/reduced/placed_tree.h"

namespace tress::test_trees {

using namespace models;

using std::numbers::pi;

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double g = 9.81;  // m/s^2

struct Expected {
  std::string name;
  std::size_t elements;
  double height;  // m, of the highest tip, as trees.h says
  bool pipe;      // sections by the pipe model
};

void PrintTo(const Expected& expected, std::ostream* out) { *out << expected.name; }

class TreeTest : public testing::TestWithParam<Expected> {
 protected:
  Tree tree{GetParam().name};
};

TEST_P(TreeTest, HasTheElementsOfTheSourceAndTheHeightItDocuments) {
  EXPECT_EQ(tree.segments.size(), GetParam().elements);
  EXPECT_NEAR(tree.top, GetParam().height, 0.02 * GetParam().height);  // two digits
}

TEST_P(TreeTest, ParentsComeFirstAndNumbersMakeSense) {
  for (std::size_t i = 0; i < tree.segments.size(); ++i) {
    const Segment& s = tree.segments[i];
    EXPECT_GE(s.parent, -1);
    EXPECT_LT(s.parent, static_cast<int>(i));
    EXPECT_GT(s.length, 0);
    EXPECT_GT(s.section.a1, 0);
    EXPECT_EQ(s.section.a1, s.section.a2);
    EXPECT_LT(s.section.a1, s.length / 2);  // a rod, not a disc
    EXPECT_EQ(norm(s.natural - s.initial), 0);
    EXPECT_LE(norm(s.natural) * s.length, pi + 4 * eps);  // at most half a turn
  }
}

TEST_P(TreeTest, IsAStrandThatTheModelsAccept) {
  Strand strand;
  strand.material = tree.material;
  strand.segments = tree.segments;
  strand.root.frame = upright();
  EXPECT_NO_THROW(check(strand));  // mounts are rotations, among others
}

TEST_P(TreeTest, TapersAndAreasOfThePlantsAddUpAtForks) {
  const Segment& first = tree.segments.front();
  double beyond = 0;  // length of the whole tree
  for (const Segment& s : tree.segments) beyond += s.length;
  for (std::size_t i = 0; i < tree.segments.size(); ++i) {
    const Segment& s = tree.segments[i];
    double carried = 0;
    for (const int k : tree.children(static_cast<int>(i))) {
      EXPECT_LE(tree.segments[at(k)].section.a1, s.section.a1);
      carried += tree.segments[at(k)].section.area();
    }
    if (!GetParam().pipe) continue;
    // area per length is that of the trunk; sums of 242 lengths are rounded
    const double own = first.section.area() / beyond * s.length;
    EXPECT_NEAR(s.section.area(), carried + own, 1000 * eps * first.section.area());
  }
}

TEST_P(TreeTest, NoTwoBranchesCoincide) {
  const auto count = static_cast<int>(tree.segments.size());
  const std::vector<int> ends = tree.free_ends();
  for (const int i : ends) {
    for (const int k : ends) {
      if (i >= k) continue;
      const double apart = norm(tree.tips[at(i)].x - tree.tips[at(k)].x);
      EXPECT_GT(apart, tree.segments[at(i)].section.a1 + tree.segments[at(k)].section.a1)
          << i << " and " << k;
    }
  }
  for (int i = -1; i < count; ++i) {
    for (const int a : tree.children(i)) {
      for (const int b : tree.children(i)) {
        if (a >= b) continue;
        // fingers are nearest: 0.36 rad
        EXPECT_LT(dot(tree.starts[at(a)].frame.e0, tree.starts[at(b)].frame.e0),
                  std::cos(0.25))
            << a << " and " << b;
      }
    }
  }
}

/// What leaves the root upwards and, at every fork, the thickest child that goes up.
std::vector<int> trunk_of(const Tree& tree) {
  std::vector<int> trunk;
  for (int i = -1;;) {
    int next = -1;
    for (const int k : tree.children(i)) {
      const double radius = tree.segments[at(k)].section.a1;
      const bool rises = tree.starts[at(k)].frame.e0.z > 0.9;
      if (rises && (next < 0 || radius > tree.segments[at(next)].section.a1)) next = k;
    }
    if (next < 0) return trunk;
    trunk.push_back(i = next);
  }
}

TEST_P(TreeTest, TrunkStandsUnderItsOwnWeightAndThatOfTheCrown) {
  const std::vector<int> trunk = trunk_of(tree);
  ASSERT_FALSE(trunk.empty());
  double height = 0, own = 0, all = 0;
  double thinnest = std::numeric_limits<double>::infinity();
  for (const int i : trunk) {
    height += tree.segments[at(i)].length;
    own += g * tree.mass(at(i));
    thinnest = std::min(thinnest, tree.segments[at(i)].section.a1);
  }
  for (std::size_t i = 0; i < tree.segments.size(); ++i) {
    bool above = false;
    for (const int k : tree.way_down(static_cast<int>(i))) above |= k == trunk.front();
    if (above) all += g * tree.mass(i);
  }
  const double stiffness = tree.material.youngs_modulus * pi * std::pow(thinnest, 4) / 4;
  // Greenhill 1881: a clamped column buckles at w L^3/EI = 7.8373; Euler: at P L^2/EI =
  // pi^2/4 under a load at its top. Dunkerley: both together no earlier than where the
  // fractions of the critical loads add up to 1. The thinnest section everywhere and all
  // of the crown at the top make it safe.
  const double greenhill = own * height * height / (7.837347438943484 * stiffness);
  const double euler = (all - own) * height * height / (pi * pi / 4 * stiffness);
  EXPECT_LT(greenhill + euler, 1);
}

TEST_P(TreeTest, GravityBendsItLessThanHalfOfTheWayToEachTip) {
  // Linear beam theory at the shape at rest: the moment at the middle of each segment of
  // all that hangs beyond, the turn that it gives the segment, and what that does at the
  // tip. Pulling hanging limbs straight is neglected, so it bounds them from above.
  const std::size_t n = tree.segments.size();
  std::vector<double> load(n, 0);
  std::vector<Vec> first_moment(n);
  std::vector<Vec> turn(n);
  for (std::size_t i = n; i-- > 0;) {
    const Segment& s = tree.segments[i];
    const Vec& x = tree.mids[i].x;
    const Frame& frame = tree.mids[i].frame;
    // the outer half of the segment itself at three quarters of its length
    const double half = g * tree.mass(i) / 2;
    const Vec lever =
        first_moment[i] - load[i] * x + half * (0.5 * (x + tree.tips[i].x) - x);
    const Vec moment = frame.back(cross(lever, Vec{0, 0, -1}));
    const double bending = tree.material.youngs_modulus * s.section.inertia1();
    const double twisting = tree.material.shear_modulus * s.section.torsion();
    turn[i] = s.length *
              (frame * Vec{moment.x / twisting, moment.y / bending, moment.z / bending});
    if (s.parent < 0) continue;
    load[at(s.parent)] += load[i] + g * tree.mass(i);
    first_moment[at(s.parent)] =
        first_moment[at(s.parent)] + first_moment[i] + g * tree.mass(i) * x;
  }
  for (const int end : tree.free_ends()) {
    Vec moved;
    double way = 0;
    for (const int i : tree.way_down(end)) {
      moved = moved + cross(turn[at(i)], tree.tips[at(end)].x - tree.mids[at(i)].x);
      way += tree.segments[at(i)].length;
    }
    EXPECT_LT(norm(moved), way / 2) << "tip of " << end;
  }
}

INSTANTIATE_TEST_SUITE_P(All, TreeTest,
                         testing::Values(Expected{"palm_tree", 8, 3.4, true},
                                         Expected{"algae", 10, 0.41, true},
                                         Expected{"complex_tree", 50, 4.0, true},
                                         Expected{"man", 81, 0.81, false},
                                         Expected{"willow", 242, 4.1, true}),
                         [](const auto& tested) { return tested.param.name; });

TEST(Man, IsSymmetricButForHisHair) {
  const Tree man("man");
  for (const int i : man.free_ends()) {
    if (man.segments[at(i)].section.a1 < 0.005) continue;  // hair
    const Vec& x = man.tips[at(i)].x;
    double nearest = std::numeric_limits<double>::infinity();
    for (const int k : man.free_ends()) {
      const Vec mirrored{man.tips[at(k)].x.x, -man.tips[at(k)].x.y, man.tips[at(k)].x.z};
      nearest = std::min(nearest, norm(mirrored - x));
    }
    // 9 segments from the root to a finger, each with some roundings of numbers up to 1
    EXPECT_LT(nearest, 100 * eps);
  }
}

TEST(Willow, HangsItsTwigs) {
  const Tree willow("willow");
  for (const int i : willow.free_ends()) {
    EXPECT_LT(willow.tips[at(i)].frame.e0.z, -0.9) << i;
  }
}

TEST(ComplexTree, SpreadsToAllSides) {
  const Tree tree("complex_tree");
  Vec low, high;
  for (const Pose& tip : tree.tips) {
    low = {std::min(low.x, tip.x.x), std::min(low.y, tip.x.y), 0};
    high = {std::max(high.x, tip.x.x), std::max(high.y, tip.x.y), 0};
  }
  for (const double side : {-low.x, -low.y, high.x, high.y}) {
    EXPECT_GT(side, 0.2 * tree.top);
  }
}

TEST(Trees, AllChoicesAreFoundAndOthersRefused) {
  std::string choices(tree_choices);
  int count = 0;
  for (std::size_t from = 0; from <= choices.size(); ++count) {
    const std::size_t bar = std::min(choices.find('|', from), choices.size());
    EXPECT_NO_THROW((void)tree_segments(choices.substr(from, bar - from)));
    EXPECT_NO_THROW((void)tree_material(choices.substr(from, bar - from)));
    from = bar + 1;
  }
  EXPECT_EQ(count, 5);
  try {
    (void)tree_segments("wilow");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("did you mean 'willow'?"));
  }
  EXPECT_THROW((void)tree_material("oak"), InputError);
}

}  // namespace tress::test_trees
