#include "experiments/validation/spring.h"

#include <cmath>
#include <memory>
#include <numbers>
#include <string>

#include "experiments/validation/rods/motion.h"
#include "experiments/validation/rods/rod.h"
#include "experiments/validation/rods/signals.h"
#include "models/effects/gravity.h"

namespace tress::experiments::validation {
namespace {

using std::numbers::pi;

constexpr double pitch_angle = 0.15;  // rad

double coil_radius(double turns) {
  return TestRod().length * std::cos(pitch_angle) / (2 * pi * turns);
}

/// Mean height of the strand, m.
Look middle_height(System& system) {
  MaterialPoints& points = *system.material_points();
  return [&points, x = std::vector<double>(3 * static_cast<std::size_t>(points.count()))](
             double t, In q, In) mutable {
    points.positions(t, q, x);
    double sum = -(x[2] + x[x.size() - 1]) / 2;  // the ends count half
    for (std::size_t i = 2; i < x.size(); i += 3) sum += x[i];
    return sum / (points.count() - 1);
  };
}

double measured_rate(const ModelTrial& trial) {
  const double sine = std::sin(pitch_angle), cosine = std::cos(pitch_angle);
  const double r = coil_radius(trial.parameter);
  TestRod rod;
  rod.natural = uniform_shape({sine * cosine / r, cosine * cosine / r, 0});
  // The axis of the helix, sine e0 + cosine e1, points down.
  const Vec e0{cosine, 0, -sine}, e1{-sine, 0, -cosine};
  const Strand strand = rod.strand(trial.elements, {e0, e1, cross(e0, e1)});
  const SpringModes modes = spring_modes(trial.parameter);
  // It sags by 1 % of its height: k = m omega^2 (2/pi)^2, sag = m g/(2 k).
  const double height = TestRod().length * sine;
  const double g = 0.02 * height * std::pow(2 * modes.low / pi, 2);
  const auto system =
      on_strand(trial.variant, strand, {std::make_shared<Gravity>(Vec{0, 0, -g})});
  // The other wave is 1.2 times as fast. Six periods do not separate the two, but the
  // weight, which pulls along the axis, excites the second a hundredth as much.
  const double once = 2 * pi / modes.low;
  const Track z =
      track("implicit_midpoint", *system, once / 50, 6 * once, middle_height(*system));
  return strongest_rate(z, 0.75 * modes.low, (modes.low + modes.high) / 2);
}

}  // namespace

SpringModes spring_modes(double turns) {
  const double r = coil_radius(turns), p = std::sin(pitch_angle);
  const double c = std::cos(pitch_angle), w = c / r;
  const double bending = TestRod().bending(), twisting = TestRod().twisting();
  const double j[2][2] = {{-w * p / c, c}, {w, p}};  // d(curvature, twist)/d(p, w)
  // Over the masses m and m r^2: A = M^-1/2 D M^-1/2.
  double a[2][2];
  for (int i = 0; i < 2; ++i) {
    for (int k = 0; k < 2; ++k) {
      a[i][k] = (j[0][i] * bending * j[0][k] + j[1][i] * twisting * j[1][k]) /
                (TestRod().line_mass() * std::pow(r, i + k));
    }
  }
  const double mean = (a[0][0] + a[1][1]) / 2, half = (a[0][0] - a[1][1]) / 2;
  const double split = std::hypot(half, a[0][1]);
  const double wave = pi / 2 / TestRod().length;
  return {wave * std::sqrt(mean - split), wave * std::sqrt(mean + split)};
}

std::vector<ValidationTest> spring_tests() {
  return {{
      .name = "bouncing_spring",
      .what = "a curly strand, let go in its natural shape, bounces as a helical spring",
      .source =
          "Bertails-Descoubes 2010, spring experiment; Love, Treatise, section 271: "
          "a bar that stretches and turns, clamped above and free below",
      .parameter = "turns of the curl",
      .quantity = "lowest frequency along the axis (rad/s)",
      .range = {4, 20},
      .quick = {{5}, {60}},
      .usual = {{4, 5}, {30, 60, 90}},
      .full = {{4, 5, 6}, {30, 60, 90, 120}},
      .tolerance = 0.03,
      .why = "chords of 12 segments a turn have 2 tan(angle/2) for an angle of 0.52 rad: "
             "bending rings 7 % too fast, of which a spring, whose wire twists more than "
             "it bends, shows a third; the ends of 5 turns make 0.4 %",
      .judged_from = 60,
      .claimed = {"super_helix", "super_clothoid", "articulated_chain", "der", "corde",
                  "xpbd_cosserat", "dynamic_spline", "kirchhoff_nodal"},
      .reference = [](double turns) { return spring_modes(turns).low; },
      .measure = measured_rate,
  }};
}

}  // namespace tress::experiments::validation
