#include <gtest/gtest.h>

#include <map>
#include <numbers>

#include "contract/input_error.h"
#include "models/effects/air_drag.h"
#include "models/effects/gravity.h"
#include "models/effects/wind.h"
#include "tests/models/effects/settle.h"

namespace tress::test_air {

using namespace models;

using std::numbers::pi;
using testing_support::Cloud;
using testing_support::FreePoints;
using testing_support::load;
using testing_support::straight;

constexpr double eps = std::numeric_limits<double>::epsilon();

using Settings = std::map<std::string, std::string>;

std::unique_ptr<const Effect> quadratic_drag(const Settings& settings) {
  Parameters parameters(quadratic_drag_parameters(), "test");
  for (const auto& [key, value] : settings) parameters.set(key, value);
  return make_quadratic_drag(parameters, {});
}

std::unique_ptr<const Effect> wind(const Settings& settings) {
  Parameters parameters(wind_parameters(), "test");
  for (const auto& [key, value] : settings) parameters.set(key, value);
  return make_wind(parameters, {});
}

constexpr double g = 9.81;             // m/s^2
constexpr double per_length = 6.5e-6;  // kg/m, a hair of 40 um
const Gravity gravity({0, 0, -g});

/// Velocity of a strand along x that has fallen for long. Its distance from the terminal
/// velocity falls at least as exp(-t/tau), tau = v/g: 40 tau leave 4e-18 of it; the
/// method's own fixed point is that of the equation.
Vec terminal(const Effect& drag, double speed) {
  FreePoints strand(straight(3, 0.1, per_length, 0), {&gravity, &drag});
  strand.run(40 * speed / g, 1000);
  return strand.velocity(1);
}

TEST(Drag, TerminalVelocityUnderTheLinearLawIsWeightOverNu) {
  const auto drag =
      wind({{"velocity_m_s", "0.7,0,0"}, {"law", "linear"}, {"drag_kg_m_s", "2e-5"}});
  const double speed = per_length * g / 2e-5;
  const Vec v = terminal(*drag, speed);
  EXPECT_NEAR(v.z, -speed, 1e-13 * speed);
  EXPECT_NEAR(v.x, 0.7, 1e-13 * speed);  // and the wind carries it
}

TEST(Drag, TerminalVelocityUnderTheQuadraticLawIsTheRootOfWeightOverDrag) {
  const auto drag = quadratic_drag({{"c_normal", "1.5"}, {"strand_radius_m", "4e-5"}});
  const double speed = std::sqrt(per_length * g / (1.2 * 1.5 * 4e-5));
  EXPECT_NEAR(terminal(*drag, speed).z, -speed, 1e-13 * speed);
}

TEST(Drag, CylinderFitIsWhitesAboveReynoldsOneAndLambsOrderBelow) {
  const double viscosity = 1.8e-5, density = 1.2, radius = 4e-5;
  const CylinderDrag drag{viscosity / 2, 2 * radius * density / viscosity};
  for (double re = 1e-4; re < 2e5; re *= 1.3) {
    const double u = re / drag.reynolds_per_speed;
    const double c_re = 2 * drag.value(u) / viscosity;  // C Re
    const double lamb = 8 * pi / (2.002 - std::log(re));
    if (re > 1) {
      EXPECT_NEAR(c_re, re + 10 * std::cbrt(re), 0.002 * c_re) << re;
    } else if (re > 0.001 && re < 0.1) {
      EXPECT_GT(c_re, 0.9 * lamb) << re;
      EXPECT_LT(c_re, 1.7 * lamb) << re;
    }
  }
  // At rest: a linear law that does not vanish, 10 Re_0^(1/3).
  EXPECT_NEAR(2 * drag.value(0) / viscosity, 10 * std::cbrt(0.1), 1e-14);
  EXPECT_NEAR(drag.value(1e-9) / drag.value(0), 1, 1e-6);
}

TEST(Drag, ForceOfTheCylinderFitIsHalfRhoCTimesTheWidthTimesTheSpeedSquared) {
  const auto drag = quadratic_drag({{"coefficients", "reynolds"}, {"c_tangential", "0"}});
  Cloud one = straight(1, 0.5, 1, 0);
  one.v = {0, 3, 0};
  const double re = 2 * 40e-6 * 1.2 * 3 / 1.8e-5;  // 16
  const double c = 1 + 10 * std::pow(re, -2.0 / 3);
  const double expected = -0.5 * 1.2 * c * 80e-6 * 9 * 0.5;
  EXPECT_NEAR(load(*drag, 0, one.points())[1], expected, 2e-5 * std::abs(expected));
}

TEST(Drag, AlongAStrandActsOnItsWholeSurface) {
  const auto drag =
      quadratic_drag({{"c_tangential", "0.02"}, {"strand_radius_m", "1e-3"}});
  Cloud one = straight(1, 0.5, 1, 0);
  one.v = {3, 0, 0};
  const auto f = load(*drag, 0, one.points());
  const double expected = -0.5 * 1.2 * 0.02 * 2 * pi * 1e-3 * 9 * 0.5;
  EXPECT_NEAR(f[0], expected, 8 * eps * std::abs(expected));
  EXPECT_EQ(f[1], 0);
  EXPECT_EQ(f[2], 0);
}

TEST(Drag, OfStillAirNeedsNoPlaces) {
  EXPECT_FALSE(quadratic_drag({})->needs().position);
  EXPECT_FALSE(wind({{"profile", "sine"}})->needs().position);
  EXPECT_FALSE(wind({})->needs().tangent);
  EXPECT_TRUE(wind({{"profile", "gusts"}})->needs().position);
}

TEST(Wind, LeavesAloneWhatMovesWithIt) {
  for (const std::string law : {"linear", "quadratic"}) {
    const auto effect = wind({{"velocity_m_s", "1,2,-0.5"}, {"law", law}});
    Cloud one(1);
    one.v = {1, 2, -0.5};
    for (const double f : load(*effect, 0, one.points())) EXPECT_EQ(f, 0);
  }
}

TEST(Wind, IsStillQuadraticDragWhenItDoesNotBlow) {
  const auto none = wind({{"velocity_m_s", "0,0,0"}, {"law", "quadratic"}});
  const Cloud cloud(20);
  const std::vector<double> f = load(*none, 0, cloud.points());
  const std::vector<double> expected = load(*quadratic_drag({}), 0, cloud.points());
  // The same sums of a dozen products; compilers may fuse them differently.
  const double rounding = 12 * eps *
                          std::abs(*std::ranges::max_element(
                              expected, {}, [](double x) { return std::abs(x); }));
  for (std::size_t i = 0; i < f.size(); ++i) EXPECT_NEAR(f[i], expected[i], rounding);
}

TEST(Wind, OfGivenForceSwingsAsASineWhateverTheVelocity) {
  const auto effect = wind({{"velocity_m_s", "0,3,4"},
                            {"profile", "sine"},
                            {"frequency_hz", "0.5"},
                            {"law", "force"},
                            {"force_n_m", "1e-4"}});
  const Cloud cloud(5);
  for (const double t : {0.0, 0.5, 1.2}) {
    const auto f = load(*effect, t, cloud.points());
    for (std::size_t i = 0; i < 5; ++i) {
      const double size = 1e-4 * cloud.length[i] * std::sin(pi * t);
      EXPECT_EQ(f[3 * i], 0);
      EXPECT_NEAR(f[3 * i + 1], 0.6 * size, 1e-4 * 8 * eps);
      EXPECT_NEAR(f[3 * i + 2], 0.8 * size, 1e-4 * 8 * eps);
    }
  }
}

TEST(Wind, OfGivenForceWantsADirection) {
  EXPECT_THROW(wind({{"velocity_m_s", "0,0,0"}, {"law", "force"}}), InputError);
}

const Vec mean{1, -0.5, 0.2};
constexpr double rms = 0.8, wave_length = 0.3, turn = 0.5;
// sum |e_m| <= sqrt(24 sum |e_m|^2) with sum |e_m|^2 = 2 rms^2; |k| <= 2 (2 pi/length).
const double most_speed = std::sqrt(2.0 * Gusts::waves) * rms;
const double most_k = 4 * pi / wave_length;

// Central differences err by h^2/6 |w'''| and by the rounding of w over h, that of angles
// up to |k| |x| + ... < 150 rad being the largest.
TEST(Gusts, HaveNoDivergence) {
  const Gusts gusts(mean, rms, wave_length, turn, 3);
  const Cloud cloud(100);
  const double h = 1e-5;
  const double bound =
      3 * (h * h / 6 * most_speed * std::pow(most_k, 3) + most_speed * 150 * eps / h);
  for (std::size_t i = 0; i < 100; ++i) {
    const Vec x = load3(&cloud.x[3 * i]);
    const Vec ex{h, 0, 0}, ey{0, h, 0}, ez{0, 0, h};
    const auto w = [&](const Vec& at) { return gusts.velocity(0.7, at); };
    const double divergence = (w(x + ex).x - w(x - ex).x + w(x + ey).y - w(x - ey).y +
                               w(x + ez).z - w(x - ez).z) /
                              (2 * h);
    EXPECT_NEAR(divergence, 0, bound);
    // Of the exact gradient to rounding: e.k = 0 up to eps |e| |k|.
    EXPECT_NEAR(trace(gusts.gradient(0.7, x)), 0, 4 * eps * most_speed * most_k);
  }
}

// |w'|^2 of a random isotropic field varies by sqrt(2/3) of its mean if it is Gaussian;
// 4000 points far apart: 1.3 %. Five times that is allowed.
TEST(Gusts, HaveTheGivenStrength) {
  const Gusts gusts(mean, rms, wave_length, turn, 5);
  const Cloud cloud(4000);
  double sum = 0;
  for (std::size_t i = 0; i < 4000; ++i) {
    const Vec w = gusts.velocity(0, 100.0 * load3(&cloud.x[3 * i])) - mean;
    sum += dot(w, w);
  }
  EXPECT_NEAR(sum / 4000 / (rms * rms), 1, 5 * 0.013);
}

// A field that turns in 1e9 s is carried unchanged; its phases have moved by 2 pi
// 2^(2/3) t/1e9 at most, and angles below 150 rad are rounded.
TEST(Gusts, AreCarriedByTheWind) {
  const Gusts gusts(mean, rms, wave_length, 1e9, 5);
  const double t = 0.9;
  for (const Vec& x : {Vec{0, 0, 0}, Vec{0.1, 0.5, -0.3}}) {
    const Vec d = gusts.velocity(t, x + t * mean) - gusts.velocity(0, x);
    EXPECT_LE(norm(d), most_speed * (10 * t / 1e9 + 4 * 150 * eps));
  }
}

TEST(Gusts, AreTheSameForEqualSeedsOnly) {
  const auto at = [](std::uint64_t seed) {
    return Gusts(mean, rms, wave_length, turn, seed).velocity(0.3, {0.1, 0.2, 0.3});
  };
  EXPECT_EQ(at(1).x, at(1).x);
  EXPECT_NE(at(1).x, at(2).x);
}

}  // namespace tress::test_air
