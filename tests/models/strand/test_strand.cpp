#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "contract/input_error.h"
#include "models/strand/strand.h"

namespace tress::test_strand {

using namespace models;

using std::numbers::pi;
constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double inf = std::numeric_limits<double>::infinity();

Strand strand_of(const Discretisation& cut, const Shape& natural = uniform_shape({}),
                 const Shape& initial = {}) {
  return make_strand(Material{}, CrossSection{}, cut, natural, initial);
}

TEST(CrossSection, CircleHasTheKnownMoments) {
  const double r = 3;
  const CrossSection circle{r, r};
  const double fourth = r * r * r * r;
  EXPECT_DOUBLE_EQ(circle.area(), pi * r * r);
  EXPECT_DOUBLE_EQ(circle.inertia1(), pi * fourth / 4);
  EXPECT_DOUBLE_EQ(circle.inertia2(), pi * fourth / 4);
  EXPECT_DOUBLE_EQ(circle.torsion(), pi * fourth / 2);
  EXPECT_DOUBLE_EQ(circle.polar(), pi * fourth / 2);
}

TEST(CrossSection, EllipseBendsHarderAcrossItsLongAxis) {
  const CrossSection ellipse{2, 1};  // long along e1: stiff about e2
  EXPECT_DOUBLE_EQ(ellipse.area(), 2 * pi);
  EXPECT_DOUBLE_EQ(ellipse.inertia1(), pi / 2);
  EXPECT_DOUBLE_EQ(ellipse.inertia2(), 2 * pi);
  EXPECT_DOUBLE_EQ(ellipse.torsion(), 8 * pi / 5);
  EXPECT_DOUBLE_EQ(ellipse.polar(), 2.5 * pi);
}

TEST(Material, ShearModulusFollowsPoissonsRatio) {
  EXPECT_DOUBLE_EQ(Material::shear_modulus_of(3e9, 0.5), 1e9);
  EXPECT_DOUBLE_EQ(Material::shear_modulus_of(3e9, 0), 1.5e9);
}

TEST(Strand, LengthsAddUpAndGrowGeometrically) {
  for (const double grading : {0.2, 1.0, 3.0}) {
    const Strand strand = strand_of({7, 0.3, grading});
    ASSERT_EQ(strand.segments.size(), 7u);
    const auto length = [&strand](std::size_t i) { return strand.segments[i].length; };
    // 7 rounded terms added one by one
    EXPECT_NEAR(strand.length(), 0.3, 14 * eps * 0.3);
    // pow with a rounded ratio: 6 (its relative error) + 2
    EXPECT_NEAR(length(6) / length(0), grading, 20 * eps * grading);
    for (std::size_t i = 0; i < 7; ++i) {
      EXPECT_EQ(strand.segments[i].parent, static_cast<int>(i) - 1);
      if (i > 1) {
        EXPECT_NEAR(length(i) / length(i - 1), length(1) / length(0), 20 * eps * grading);
      }
    }
  }
}

TEST(Strand, OneElementTakesTheWholeLength) {
  EXPECT_DOUBLE_EQ(strand_of({1, 0.3, 5}).length(), 0.3);
}

TEST(Strand, MassIsDensityTimesVolume) {
  Material material;
  material.density = 1000;
  const Strand strand =
      make_strand(material, {2e-3, 1e-3}, {4, 0.5, 2}, uniform_shape({}));
  EXPECT_NEAR(strand.mass(), 1000 * pi * 2e-6 * 0.5, 20 * eps * strand.mass());
}

TEST(Strand, LengthOfATreeIsItsLongestWay) {
  Strand tree = strand_of({2, 0.2, 1});
  Segment twig = tree.segments[0];
  twig.parent = 0;
  twig.length = 0.5;
  tree.segments.push_back(twig);
  twig.length = 0.05;
  tree.segments.push_back(twig);
  check(tree);
  EXPECT_DOUBLE_EQ(tree.length(), 0.1 + 0.5);
}

TEST(Shape, UniformIsKeptAndInitialIsNaturalUnlessGiven) {
  const Vec natural{1, 20, -3}, initial{0, 5, 0};
  const auto expect_equal = [](const Vec& a, const Vec& b) {
    // the eight weights add up to 1 within a few roundings
    EXPECT_NEAR(a.x, b.x, 8 * eps * 20);
    EXPECT_NEAR(a.y, b.y, 8 * eps * 20);
    EXPECT_NEAR(a.z, b.z, 8 * eps * 20);
  };
  for (const Segment& s : strand_of({3, 0.1, 1}, uniform_shape(natural)).segments) {
    expect_equal(s.natural, natural);
    expect_equal(s.initial, natural);
  }
  for (const Segment& s :
       strand_of({3, 0.1, 1}, uniform_shape(natural), uniform_shape(initial)).segments) {
    expect_equal(s.natural, natural);
    expect_equal(s.initial, initial);
  }
}

TEST(Shape, WavyAveragesAreTheExactIntegral) {
  const double amplitude = 100, wavelength = 0.05;
  const Strand strand = strand_of({9, 0.1, 3}, wavy_shape(amplitude, wavelength));
  const double rate = 2 * pi / wavelength;
  double from = 0, longest = 0, swing = 0;
  for (const Segment& s : strand.segments) {
    const double to = from + s.length;
    const double exact =
        amplitude * (std::sin(rate * to) - std::sin(rate * from)) / (rate * s.length);
    // Gauss error below 2.2e-18 (rate l/2)^16 / 2 of the amplitude: 1e-16 for the longest
    // l of 0.02 m; rounding of the exact value: 4 eps / (rate l), l >= 0.006 m
    EXPECT_NEAR(s.natural.y, exact, 10 * eps * amplitude);
    EXPECT_EQ(s.natural.x, 0);
    EXPECT_EQ(s.natural.z, 0);
    longest = std::max(longest, s.length);
    swing = std::max(swing, std::abs(exact));
    from = to;
  }
  EXPECT_LT(longest, 0.02);
  EXPECT_GT(swing, 50);
}

TEST(Shape, OneWaveInOneSegmentAveragesOut) {
  const Strand strand = strand_of({1, 0.05, 1}, wavy_shape(100, 0.05));
  EXPECT_LE(std::abs(strand.segments[0].natural.y), 1e-9 * 100);
}

/// The centreline over the arc length `to`: Simpson on the tangent, whose fourth
/// derivative is |kappa|^4. One turn in 2000 steps h: (to/180) h^4 |kappa|^4 <= 4e-12 of
/// one turn.
Vec follow(const Vec& darboux, double to) {
  const double w = norm(darboux);
  const int steps = 2000;
  const double h = to / steps;
  Vec x;
  for (int i = 0; i <= steps; ++i) {
    const double weight = i == 0 || i == steps ? 1 : i % 2 == 1 ? 4 : 2;
    x = x + weight * h / 3 * rotation((1 / w) * darboux, w * h * i).e0;
  }
  return x;
}

TEST(Shape, HelixHasItsRadiusAndPitch) {
  for (const double pitch : {0.03, -0.03}) {
    const double radius = 0.01;
    const Strand strand = strand_of({1, 0.1, 1}, helix_shape(radius, pitch));
    const Vec darboux = strand.segments[0].natural;
    EXPECT_GT(darboux.y, 0);  // curvature about e1
    const double w = norm(darboux);
    const Vec axis = (1 / w) * darboux;  // the frame turns about it, positively
    const Vec turn = follow(darboux, 2 * pi / w), half = follow(darboux, pi / w);
    EXPECT_NEAR(dot(turn, axis), pitch, 1e-12);
    const Vec across = half - dot(half, axis) * axis;
    EXPECT_NEAR(norm(across), 2 * radius, 1e-12);
    const Vec left = turn - dot(turn, axis) * axis;
    EXPECT_LE(norm(left), 1e-12);
  }
}

TEST(Shape, RefusesWhatIsNoShape) {
  EXPECT_THROW(helix_shape(0, 0.1), InputError);
  EXPECT_THROW(helix_shape(nan, 0.1), InputError);
  EXPECT_THROW(helix_shape(1, inf), InputError);
  EXPECT_THROW(wavy_shape(1, 0), InputError);
  EXPECT_THROW(wavy_shape(nan, 1), InputError);
}

TEST(Strand, RefusesABadCut) {
  EXPECT_THROW(strand_of({0, 0.1, 1}), InputError);
  EXPECT_THROW(strand_of({-3, 0.1, 1}), InputError);
  for (const double bad : {0.0, -0.1, nan, inf}) {
    EXPECT_THROW(strand_of({5, bad, 1}), InputError);
    EXPECT_THROW(strand_of({5, 0.1, bad}), InputError);
  }
  EXPECT_THROW(strand_of({5, 0.1, 1}, Shape{}), InputError);
  EXPECT_THROW(strand_of({5, 0.1, 1}, uniform_shape({0, nan, 0})), InputError);
  EXPECT_THROW(strand_of({5, 0.1, 1}, uniform_shape({}), uniform_shape({inf, 0, 0})),
               InputError);
  // so graded that the first length underflows
  EXPECT_THROW(strand_of({2, 1e-300, 1e300}), InputError);
}

/// `spoil` makes a good strand bad; the message must name the place.
template <class Spoil>
void expect_refused(const Spoil& spoil, const std::string& place) {
  Strand strand = strand_of({3, 0.1, 1});
  check(strand);
  spoil(strand);
  try {
    check(strand);
    ADD_FAILURE() << "accepted; should be refused in: " << place;
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("(" + place), std::string::npos)
        << error.what();
  }
}

TEST(Strand, RefusesABadSegmentByItsIndex) {
  expect_refused([](Strand& s) { s.segments.clear(); }, "strand");
  expect_refused([](Strand& s) { s.segments[1].parent = 1; }, "segment 1");
  expect_refused([](Strand& s) { s.segments[1].parent = 2; }, "segment 1");
  expect_refused([](Strand& s) { s.segments[0].parent = -2; }, "segment 0");
  for (const double bad : {0.0, -1.0, nan, inf}) {
    expect_refused([=](Strand& s) { s.segments[2].length = bad; }, "segment 2");
    expect_refused([=](Strand& s) { s.segments[2].section.a1 = bad; }, "segment 2");
    expect_refused([=](Strand& s) { s.segments[2].section.a2 = bad; }, "segment 2");
  }
  expect_refused([](Strand& s) { s.segments[1].natural.x = nan; }, "segment 1");
  expect_refused([](Strand& s) { s.segments[1].initial.z = inf; }, "segment 1");
}

TEST(Strand, RefusesMountsThatAreNoRotation) {
  const Frame bad[] = {
      {{1, 0, 0}, {0, 1, 0}, {0, 0, -1}},        // a reflection
      {{1, 0, 0}, {0, 1, 0}, {0, 0, 1 + 1e-9}},  // stretched
      {{1, 0, 0}, {1e-9, 1, 0}, {0, 0, 1}},      // sheared
      {{nan, 0, 0}, {0, 1, 0}, {0, 0, 1}},
  };
  for (const Frame& frame : bad) {
    expect_refused([&](Strand& s) { s.segments[1].mount = frame; }, "segment 1");
    expect_refused([&](Strand& s) { s.root.frame = frame; }, "root motion");
    expect_refused(
        [&](Strand& s) {
          s.free_root = FreeRoot{{}, frame, {}, {}};
        },
        "free root");
  }
  Strand good = strand_of({3, 0.1, 1});
  good.segments[1].mount = rotation({0.6, 0, 0.8}, 2.5);
  EXPECT_NO_THROW(check(good));
}

TEST(Strand, RefusesBadMaterialAndRoot) {
  for (const double bad : {0.0, -1.0, nan, inf}) {
    expect_refused([=](Strand& s) { s.material.density = bad; }, "material");
    expect_refused([=](Strand& s) { s.material.youngs_modulus = bad; }, "material");
    expect_refused([=](Strand& s) { s.material.shear_modulus = bad; }, "material");
  }
  for (const double bad : {-1.0, nan, inf}) {
    expect_refused([=](Strand& s) { s.material.internal_friction = bad; }, "material");
  }
  expect_refused([](Strand& s) { s.root.position.x = nan; }, "root motion");
  expect_refused(
      [](Strand& s) {
        s.free_root = FreeRoot{{nan, 0, 0}, {}, {}, {}};
      },
      "free root");
  expect_refused(
      [](Strand& s) {
        s.free_root = FreeRoot{{}, {}, {0, inf, 0}, {}};
      },
      "free root");
  expect_refused(
      [](Strand& s) {
        s.free_root = FreeRoot{{}, {}, {}, {0, 0, nan}};
      },
      "free root");
}

}  // namespace tress::test_strand
