#include <cmath>
#include <numbers>
#include <stdexcept>

#include "experiments/validation/exact_rods.h"
#include "experiments/validation/rods/numerics.h"
#include "experiments/validation/rods/rod.h"
#include "experiments/validation/rods/statics.h"
#include "experiments/validation/test.h"

namespace tress::experiments::validation {
namespace {

using std::numbers::pi;

constexpr Vec downwards{0, 0, -1};

double distance(const Vec& x, const Vec& y) { return std::sqrt(dot(x - y, x - y)); }

double unity(double) { return 1; }

/// Starts nearly straight; the strand closes on its clamp.
double measure_roll_up(const ModelTrial& trial) {
  TestRod rod;
  const double curvature = 2 * pi * trial.parameter / rod.length;
  rod.natural = uniform_shape({0, curvature, 0});
  rod.initial = uniform_shape({0, 0.95 * curvature, 0});
  Statics statics(trial.variant, rod.strand(trial.elements, horizontal_clamp()), {});
  statics.relax(1);
  return 1 + distance(statics.tip(), {}) / rod.length;
}

// Curly hair of 15 cm, radius 8 mm and pitch 10 mm: curvature and twist times L, tip over
// L in equilibrium under its weight. Boundary-value problem of Kirchhoff's equations on
// two meshes that agree to 1e-12 (GJ/EI = 1/1.4).
constexpr double curly_curvature = 18.0361544841071, curly_twist = 3.58817892564338;
constexpr double curly_gamma = 35.8678125;
constexpr Vec curly_tip{0.1575486055087, 0.0070779385289, -0.2017219830847};

double measure_curly_hair(const ModelTrial& trial) {
  TestRod rod{.poisson_ratio = 0.4};
  rod.natural = uniform_shape((1 / rod.length) * Vec{curly_twist, 0, curly_curvature});
  Statics statics(trial.variant, rod.strand(trial.elements, hanging_clamp()),
                  rod.gravity(curly_gamma) * downwards);
  statics.follow(0.01, 1);
  return 1 + distance((1 / rod.length) * statics.tip(), curly_tip);
}

constexpr double spring_pitch_angle = 15 * pi / 180, spring_turns = 8;

double spring_rise(double force) {
  const PulledHelix helix =
      pulled_helix(spring_pitch_angle, TestRod{}.poisson_ratio, force);
  return std::sin(helix.pitch_angle) / std::sin(spring_pitch_angle);
}

/// End effects reach about sqrt(EI/F): the middle third of eight turns is uniform. Rise
/// along the axis over arc length, relative to that at rest.
double measure_spring(const ModelTrial& trial) {
  TestRod rod;
  const double c = std::cos(spring_pitch_angle), s = std::sin(spring_pitch_angle);
  const double radius = rod.length * c / (2 * pi * spring_turns);
  rod.natural = uniform_shape((c / radius) * Vec{s, c, 0});
  const Frame clamp = horizontal_clamp();
  const Vec axis = clamp * Vec{s, c, 0};  // along the Darboux vector
  const double unit = rod.bending() / (radius * radius);
  Statics statics(trial.variant, rod.strand(trial.elements, clamp), {},
                  {.force = (trial.parameter * unit) * axis});
  statics.follow(std::min(1.0, 0.01 / trial.parameter), 1);
  const std::vector<double> x = statics.points();
  const auto n = static_cast<std::size_t>(trial.elements);
  const std::size_t from = n / 3, to = n - n / 3;
  const double arc = rod.length * static_cast<double>(to - from) / static_cast<double>(n);
  return dot(axis, load3(&x[3 * to]) - load3(&x[3 * from])) / (arc * s);
}

// nu = 0.5: incompressible, as the experiments' silicone.
double reference_curl(double half_turns) {
  return curl_threshold(half_turns * pi, TestRod{}.poisson_ratio);
}

double measure_curl(const ModelTrial& trial) {
  const double phi = trial.parameter * pi;
  constexpr double start = 2, lowest = 0.3, step = 0.97;  // of Gamma^(1/3)/phi
  TestRod rod;
  rod.natural = uniform_shape({0, phi / rod.length, 0});
  rod.initial = uniform_shape(Vec{});
  Statics statics(trial.variant, rod.strand(trial.elements, hanging_clamp()),
                  rod.gravity(std::pow(start * phi, 3)) * downwards);
  const auto load = [](double ratio) { return std::pow(ratio / start, 3); };
  double at = 0.9;
  statics.follow(1, load(at));
  while (statics.least_square() > 0) {
    at *= step;
    if (at < lowest) throw std::runtime_error("the strand stays in its plane");
    statics.relax(load(at));
  }
  return find_root(
      [&](double ratio) {
        statics.relax(load(ratio));
        return statics.least_square();
      },
      at, at / step, 1e-6);
}

// Cantilever of 45 degrees [Bathe & Bolourchi 1979]: radius 100, E = 1e7, nu = 0, unit
// square: EI = GJ = 1e7/12, force 600 across its plane. Out-of-plane displacement of the
// tip of the inextensible rod, from Kirchhoff's equations (the published 53.4 includes
// stretch and shear).
constexpr double bathe_radius = 100, bathe_force = 600, bathe_bending = 1e7 / 12;
constexpr double bathe_tip = 53.46859844;

double measure_bathe(const ModelTrial& trial) {
  const double arc = pi / 4;
  TestRod rod{.poisson_ratio = 0};
  rod.natural = uniform_shape({0, arc / rod.length, 0});
  const double length = arc * bathe_radius;
  const double load = bathe_force * length * length / bathe_bending;
  Statics statics(trial.variant, rod.strand(trial.elements, horizontal_clamp()), {},
                  {.force = load * rod.force() * Vec{0, 1, 0}});
  statics.follow(0.01, 1);
  return statics.tip().y / rod.length * length;
}

}  // namespace

/// Strands with a natural curvature or twist.
std::vector<ValidationTest> curl_tests() {
  const std::vector<std::string_view> rods{"super_helix", "super_clothoid", "der",
                                           "corde", "dynamic_spline"};
  return {
      {
          .name = "roll_up",
          .what = "weightless strand that is naturally n full circles",
          .source = "a moment of 2 pi n EI/L closes n circles exactly",
          .parameter = "n",
          .quantity = "1 + distance of the ends over L",
          .range = {1, 10, true},
          .quick = {{1}, {10, 20}},
          .usual = {{1, 2}, {10, 20, 40}},
          .full = {{1, 2, 3}, {10, 20, 40, 80}},
          .tolerance = 0.01,
          .why = "chords of circles close as circles do; the cubics of a spline do not",
          .judged_from = 20,
          .claimed = rods,
          .reference = unity,
          .measure = measure_roll_up,
      },
      {
          .name = "curly_hair",
          .what = "helix of 2.9 turns hanging in its weight",
          .source = "Kirchhoff's equations as a boundary-value problem on two meshes",
          .parameter = "none: 0",
          .quantity = "1 + distance of the tip from the reference over L",
          .range = {0, 0},
          .quick = {{0}, {24, 48}},
          .usual = {{0}, {12, 24, 48}},
          .full = {{0}, {12, 24, 48, 96}},
          .tolerance = 0.01,
          .why = "1 % of the length, as for cantilevers",
          .judged_from = 48,
          .claimed = rods,
          .reference = unity,
          .refusal = no_curl,
          .measure = measure_curly_hair,
      },
      {
          .name = "love_spring",
          .what = "helix of eight turns, pitch angle 15 degrees, pulled along its axis",
          .source = "Love 1927, section 271",
          .parameter = "F r_0^2/EI",
          .quantity = "rise per length over that at rest, in the middle third",
          .range = {0.1, 2},
          .quick = {{0.5}, {128}},
          .usual = {{0.1, 0.5, 1, 2}, {64, 128}},
          .full = {{0.1, 0.3, 0.5, 0.8, 1, 2}, {64, 128, 192}},
          .tolerance = 0.02,
          .why = "2 % is wanted; at 16 elements a turn each bends by 22 degrees, and "
                 "curvature as a tangent of the half angle is off by 1.2 %",
          .judged_from = 128,
          .claimed = rods,
          .reference = spring_rise,
          .refusal = no_curl,
          .measure = measure_spring,
      },
      {
          .name = "bend_twist",
          .what = "hanging strand that is naturally an arc: from its plane into space",
          .source =
              "Romero et al. 2021; Miller et al. 2014; second variation by shooting",
          .parameter = "angle of the arc over pi",
          .quantity = "Gamma^(1/3)/phi at which the plane is left",
          .range = {1.9, 6},
          .quick = {{2}, {20, 40}},
          .usual = {{2, 3, 4}, {10, 20, 40, 80}},
          .full = {{1.9, 2, 2.5, 3, 4, 5}, {10, 20, 40, 80}},
          .tolerance = 0.03,
          .why = "3 % is wanted",
          .judged_from = 40,
          .claimed = rods,
          .reference = reference_curl,
          .refusal = no_curl,
          .measure = measure_curl,
      },
      {
          .name = "bathe_45",
          .what = "arc of 45 degrees, a dead force across its plane",
          .source = "Bathe & Bolourchi 1979; Kirchhoff's equations",
          .parameter = "none: 0",
          .quantity = "way of the tip across the plane, of a radius of 100",
          .range = {0, 0},
          .quick = {{0}, {10, 20}},
          .usual = {{0}, {5, 10, 20, 40}},
          .full = {{0}, {5, 10, 20, 40, 80}},
          .tolerance = 0.01,
          .why = "as the other cantilevers",
          .judged_from = 20,
          .claimed = rods,
          .reference = [](double) { return bathe_tip; },
          .refusal = no_curl,
          .measure = measure_bathe,
      },
  };
}

}  // namespace tress::experiments::validation
