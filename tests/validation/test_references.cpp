#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "contract/input_error.h"
#include "experiments/validation/exact_rods.h"
#include "experiments/validation/localised_buckling.h"
#include "experiments/validation/rods/beam_modes.h"
#include "experiments/validation/rods/master_curve.h"
#include "experiments/validation/rods/numerics.h"

/// References against values computed independently of this code: boundary-value problems
/// on two meshes that agree to 1e-12, and published zeros.
namespace tress::test_references {

using namespace experiments;
using namespace experiments::validation;

TEST(MasterCurve, IsThatOfTheElastica) {
  constexpr double height_over_width[][2] = {
      {0.01, 1.249999553589576e-3}, {0.1, 1.249955365543758e-2}, {1, 0.124561766441707},
      {10, 1.06680232043307},       {100, 5.88810462332732},     {1e3, 21.3354404999},
      {1e4, 69.7088295792},         {1e5, 222.6114204}};
  for (const auto& [gamma, ratio] : height_over_width) {
    const Cantilever rod = cantilever(gamma, 0);
    EXPECT_NEAR(rod.height / rod.width / ratio, 1, 1e-10) << gamma;
  }
}

TEST(MasterCurve, HasTheTipLoadOfBisshoppAndDrucker) {
  constexpr double alpha_angle_height_width[][4] = {
      {0.1, 0.049954255754753138, 0.033295319268174331, 0.99933460003695242},
      {1, 0.46135194971187896, 0.30172077379981353, 0.94356676371662312},
      {10, 1.4302855388038575, 0.81060902488029645, 0.44500440224624873},
      {100, 1.5706458846600332, 0.94142135086201098, 0.14142135543711792}};
  for (const auto& [alpha, angle, height, width] : alpha_angle_height_width) {
    const Cantilever rod = cantilever(0, alpha);
    EXPECT_NEAR(rod.tip_angle, angle, 1e-10) << alpha;
    EXPECT_NEAR(rod.height, height, 1e-10) << alpha;
    EXPECT_NEAR(rod.width, width, 1e-10) << alpha;
  }
}

TEST(MasterCurve, RefusesLoadsOutOfRange) {
  EXPECT_THROW(cantilever(-1, 0), InputError);
  EXPECT_THROW(cantilever(0, 0), InputError);
  EXPECT_THROW(cantilever(2e5, 0), InputError);
}

TEST(HeavyRod, HasTheModesOfABeamAndOfAHeavyRod) {
  constexpr double beam[] = {3.5160152685001512, 22.03449156466677, 61.697214413549102,
                             120.90191605230572, 199.85953011680345};
  for (int mode = 1; mode <= 5; ++mode) {
    EXPECT_NEAR(heavy_rod_mode(0, mode) / beam[mode - 1], 1, 1e-11) << mode;
  }
  constexpr double first_and_second[][3] = {
      {-7.8, 0.243259604592, 20.4436611487}, {-7, 1.15155322617, 20.612760578},
      {1, 3.73262569953, 22.2297969559},     {10, 5.29178335724, 23.9119990469},
      {100, 12.8687419059, 36.5091671279},   {1000, 38.6955051341, 92.2800860864}};
  for (const auto& [gamma, first, second] : first_and_second) {
    EXPECT_NEAR(heavy_rod_mode(gamma, 1) / first, 1, 1e-10) << gamma;
    EXPECT_NEAR(heavy_rod_mode(gamma, 2) / second, 1, 1e-10) << gamma;
  }
  EXPECT_NEAR(heavy_rod_mode(1e4, 1), 120.86470755, 1e-8);
  EXPECT_THROW(heavy_rod_mode(-7.9, 1), InputError);
}

// A nearly straight arc is a beam; its shape moves omega by O(opening^2).
TEST(CurvedBeam, TendsToTheBeam) {
  for (int mode = 1; mode <= 3; ++mode) {
    const double beam = heavy_rod_mode(0, mode);
    EXPECT_NEAR(curved_beam_mode(1e-4, mode) / beam, 1, 1e-7) << mode;
  }
}

// phi/pi, nu, Gamma^(1/3)/phi, to the 1e-6 of curl_threshold().
TEST(Curl, LeavesItsPlaneWhereItsSecondVariationDoes) {
  constexpr double thresholds[][3] = {{1.9, 0.5, 0.5563589817}, {2, 0.5, 0.5789202249},
                                      {3, 0.5, 0.6202302602},   {4, 0.5, 0.6206878389},
                                      {6, 0.5, 0.6206884527},   {2, 0.3, 0.5200728979},
                                      {4, 0.4, 0.601042019}};
  for (const auto& [half_turns, poisson_ratio, ratio] : thresholds) {
    EXPECT_NEAR(curl_threshold(half_turns * std::numbers::pi, poisson_ratio), ratio, 1e-6)
        << half_turns << " " << poisson_ratio;
  }
  EXPECT_THROW(curl_threshold(1.5 * std::numbers::pi, 0.5), InputError);
}

// nu, pitch angle (degrees), F, radius, pitch angle (rad).
TEST(HelicalSpring, IsThatOfLove) {
  constexpr double springs[][5] = {{0.5, 15, 0.01, 0.994617430849882, 0.276860850274938},
                                   {0.5, 15, 0.5, 0.761449300423092, 0.77853677041431},
                                   {0.5, 15, 2, 0.415173205615362, 1.34153992468928},
                                   {0.3, 5, 0.3, 0.934553828911364, 0.445071332844688},
                                   {0.3, 30, 1, 0.510479402744105, 1.18529311724342}};
  for (const auto& [poisson_ratio, degrees, force, radius, pitch] : springs) {
    const PulledHelix helix =
        pulled_helix(degrees * std::numbers::pi / 180, poisson_ratio, force);
    EXPECT_NEAR(helix.radius, radius, 1e-12);
    EXPECT_NEAR(helix.pitch_angle, pitch, 1e-12);
  }
}

// B = 1.345, C = 0.789, 27 turns and a shortening of 3 %, as published benchmarks have
// it: m = M L/B and t = T L^2/B solve d = sqrt((16/t)(1 - m^2/(4t))), R = m B/C + 4
// acos(m/(2 sqrt(t))).
TEST(LocalisedHelix, HasTheForcesOfThePublishedCase) {
  constexpr double m = 98.54149617119074, t = 2900.993205792131;
  const LocalisedHelix helix{2 * std::acos(m / (2 * std::sqrt(t))),
                             std::sqrt(t - m * m / 4), 1.345 / 0.789};
  EXPECT_NEAR(helix.tension() / t, 1, 1e-12);
  EXPECT_NEAR(helix.moment() / m, 1, 1e-12);
  EXPECT_NEAR(helix.shortening(), 0.03, 1e-12);
  EXPECT_NEAR(helix.turning(), 27 * 2 * std::numbers::pi, 1e-9);
}

// Frames integrated along the Darboux vector. The rod is not endless: its clamp's frame
// is off by the tilt there, 4 exp(-decay/2) sin(tilt/2) = 6.7e-4, and the other end's
// tilt comes on top; cosines near 1 are off by half of the square of both.
TEST(LocalisedHelix, CurvesAsItsForcesSay) {
  const LocalisedHelix helix{std::numbers::pi / 3, 16, 1.5};
  const Slope slope = [&](double s, const double* y, double* dy) {
    const Vec e[] = {load3(y), load3(y + 3), load3(y + 6)};
    const Vec k = helix.darboux(s);
    const Vec omega = k.x * e[0] + k.y * e[1] + k.z * e[2];
    for (int i = 0; i < 3; ++i) store3(cross(omega, e[i]), dy + 3 * i);
    store3(e[0], dy + 9);
  };
  const double off = 4 * std::exp(-8) * std::sin(helix.largest_tilt / 2);
  std::vector<double> y{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
  y = integrate_scaled(slope, 0, 0.5, y);
  EXPECT_NEAR(y[0], std::cos(helix.largest_tilt), 2 * off);
  y = integrate_scaled(slope, 0.5, 1, y);
  EXPECT_NEAR(y[9], 1 - helix.shortening(), 2 * off);
  EXPECT_NEAR(std::hypot(y[10], y[11]), 0, 2 * off);
  EXPECT_NEAR(y[0], 1, 2 * off * off);
  EXPECT_NEAR(y[4], std::cos(helix.turning()), 2 * off);
  EXPECT_NEAR(y[5], std::sin(helix.turning()), 2 * off);
}

}  // namespace tress::test_references
