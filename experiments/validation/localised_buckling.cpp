#include "experiments/validation/localised_buckling.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "experiments/validation/rods/rod.h"
#include "experiments/validation/rods/statics.h"

namespace tress::experiments::validation {
namespace {

using std::numbers::pi;

constexpr double decay = 12;  // the ends' tilt is below 0.01
constexpr Vec axis_x{1, 0, 0}, axis_y{0, 1, 0}, axis_z{0, 0, 1};

/// With the natural twist for which the sections follow the helix in its tails, without
/// an additional turn within the elements.
LocalisedHelix helix(const TestRod& rod, double degrees) {
  LocalisedHelix all{degrees * pi / 180, decay, 1 + rod.poisson_ratio};
  all.natural_twist = all.moment() / 2 - all.twist();
  return all;
}

double measured_tension(const ModelTrial& trial) {
  TestRod rod;
  const LocalisedHelix expected = helix(rod, trial.parameter);
  rod.natural = uniform_shape({expected.natural_twist / rod.length, 0, 0});
  rod.initial = [&](double s) {
    return (1 / rod.length) * expected.darboux(s / rod.length);
  };
  const Strand strand = rod.strand(trial.elements, horizontal_clamp());
  const double c = std::cos(expected.turning()), s = std::sin(expected.turning());
  End end = held_section(trial.variant, strand, End::Section::frame,
                         {axis_x, {0, c, s}, {0, -s, c}});
  end.along = {axis_x, axis_y, axis_z};
  end.place = {(1 - expected.shortening()) * rod.length, 0, 0};
  Statics statics(trial.variant, strand, {}, end);
  statics.relax(1);
  return statics.holding()[0] / rod.force();
}

}  // namespace

double LocalisedHelix::tension() const {
  return std::pow(decay / std::sin(largest_tilt / 2), 2);
}

double LocalisedHelix::moment() const {
  return 2 * std::sqrt(tension()) * std::cos(largest_tilt / 2);
}

double LocalisedHelix::shortening() const {
  return 4 * std::pow(std::sin(largest_tilt / 2), 2) / decay;
}

double LocalisedHelix::twist() const { return natural_twist + bend_to_twist * moment(); }

double LocalisedHelix::turning() const { return twist() + 2 * largest_tilt; }

Vec LocalisedHelix::darboux(double s) const {
  // Euler's angles about the pull, the tilted axis and the tangent: precession psi, tilt
  // theta, spin phi. Moments about the pull and the tangent are both M, so psi' = M/(1 +
  // cos theta) and phi' = twist - psi' cos theta; psi is the sum of M s/2 and twice the
  // angle by which half the tilt has passed its maximum.
  const double x = decay * (s - 0.5), slope = std::tan(largest_tilt / 2);
  const double half = std::asin(std::sin(largest_tilt / 2) / std::cosh(x));
  const double theta = 2 * half;
  const double theta_slope = -2 * decay * std::tanh(x) * std::tan(half);
  const auto psi_at = [&](double y) {
    return moment() * y / (2 * decay) + std::atan(slope * std::tanh(y));
  };
  const double psi = psi_at(x) - psi_at(-decay / 2);
  const double psi_slope = moment() / (1 + std::cos(theta));
  // psi + phi turns by the twist and by psi' (1 - cos theta).
  const double phi = twist() * s + 2 * (psi - moment() * s / 2) - psi;
  return {twist(),
          psi_slope * std::sin(theta) * std::sin(phi) + theta_slope * std::cos(phi),
          psi_slope * std::sin(theta) * std::cos(phi) - theta_slope * std::sin(phi)};
}

std::vector<ValidationTest> localised_buckling_tests() {
  return {{
      .name = "localised_helix",
      .what = "long rod, pulled and twisted, that winds up in its middle",
      .source = "Coyne 1990; van der Heijden & Thompson 2000: closed form",
      .parameter = "largest tilt against the pull (degrees)",
      .quantity = "T L^2/EI that holds the ends at that shortening and turning",
      // At cos(tilt) = -D GJ/(2 EI), 93 degrees, two equilibria with the same ends
      // coincide; near it the result is sensitive to the smallest errors.
      .range = {45, 65},
      .quick = {{60}, {40, 80}},
      .usual = {{45, 55, 65}, {40, 80, 160}},
      .full = {{45, 50, 55, 60, 65}, {40, 80, 160}},
      .tolerance = 0.05,
      .why = "a segment turns by 0.35 rad about the pull: strains of chords are off by "
             "0.35^2/12 = 1 %, and the tension goes with squares of two rates that are "
             "off by as much",
      .judged_from = 80,
      .claimed = {"super_helix", "super_clothoid", "der", "corde", "dynamic_spline"},
      .reference = [](double degrees) { return helix(TestRod{}, degrees).tension(); },
      .refusal = no_section,
      .measure = measured_tension,
  }};
}

}  // namespace tress::experiments::validation
