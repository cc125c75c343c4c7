#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>

#include "contract/constants.h"
#include "experiments/family/family.h"
#include "experiments/problems/strand_models.h"
#include "models/catalogue.h"
#include "models/effects/wind.h"
#include "models/strand/strand_parameters.h"
#include "simulation/groom/random.h"

namespace tress::experiments::family {
namespace {

constexpr double density = 1300;  // kg/m^3
constexpr double twist_per_curvature = 0.3;
constexpr double share_without_friction = 0.25;
constexpr int least_elements = 20;
constexpr double most_winding = 1.5;  // rad per element

struct Range {
  double low, high;
  double at(double u) const { return low + u * (high - low); }
  double log_at(double u) const { return low * std::pow(high / low, u); }
};

constexpr Range lengths{0.03, 0.4}, radii{20e-6, 60e-6}, moduli{1e6, 4e9},
    ellipticities{1, 1.6}, curvatures{0, 300}, frictions{1e-13, 1e-10}, frequencies{1, 4},
    amplitudes{0.01, 0.05}, angles{0.2, 0.8}, winds{0.5, 5};

/// One coordinate of all hairs: a random position within each of `count` equal parts of
/// [0, 1), in random order.
std::vector<double> coordinate(int count, std::uint64_t seed, std::uint64_t dimension) {
  Random random(seed, dimension);
  std::vector<double> places(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < places.size(); ++i) {
    places[i] = (static_cast<double>(i) + random.uniform()) / count;
  }
  for (std::size_t i = places.size(); i > 1; --i) {  // Fisher & Yates 1938
    const auto j = static_cast<std::size_t>(random.uniform() * static_cast<double>(i));
    std::swap(places[i - 1], places[j]);
  }
  return places;
}

double friction_at(double u) {
  if (u < share_without_friction) return 0;
  return frictions.log_at((u - share_without_friction) / (1 - share_without_friction));
}

std::string text(double x) { return fmt::format("{}", x); }

Parameters wind_of(const Hair& hair) {
  Parameters wind(wind_parameters(), "effect wind");
  wind.set("velocity_m_s", fmt::format("0,{},0", wind_speed(hair)));
  wind.set("profile", "sine");
  wind.set("frequency_hz", text(hair.frequency));
  wind.set("drag_kg_m_s", text(wind_drag));
  return wind;
}

}  // namespace

std::string_view name(Drive drive) {
  switch (drive) {
    case Drive::shake:
      return "shake";
    case Drive::turning_head:
      return "turning_head";
    case Drive::release:
      return "release";
    case Drive::wind:
      break;
  }
  return "wind";
}

// Mass per length over bending stiffness: rho pi r^2 / (E pi r^4/4).
double Hair::gravito_bending() const {
  return 4 * density * earth_gravity * std::pow(length, 3) /
         (youngs_modulus * radius * radius);
}

double Hair::winding() const {
  return natural_curvature * std::hypot(1, twist_per_curvature) * length;
}

void Hair::describe(Row& row) const {
  row.set("length_m", length).set("radius_m", radius);
  row.set("youngs_modulus_pa", youngs_modulus).set("ellipticity", ellipticity);
  row.set("natural_curvature_1_m", natural_curvature);
  row.set("internal_friction_kg_m3_s", internal_friction);
  row.set("drive", name(drive)).set("drive_level", level).set("frequency_hz", frequency);
  row.set("gravito_bending", gravito_bending()).set("winding_rad", winding());
}

std::vector<Column> hair_columns() {
  return {{"length_m", "length of the hair"},
          {"radius_m", "radius of the section; of an ellipse the geometric mean"},
          {"youngs_modulus_pa", "Young's modulus"},
          {"ellipticity", "half-axis along e1 over half-axis along e2"},
          {"natural_curvature_1_m", "curvature at rest; twist at rest is 0.3 of it"},
          {"internal_friction_kg_m3_s", "friction of bending and twisting"},
          {"drive", "what moves the hair: shake, turning_head, release or wind"},
          {"drive_level", "strength of the drive between its least (0) and most (1)"},
          {"frequency_hz", "of the drive"},
          {"gravito_bending", "rho A g L^3/(EI)"},
          {"winding_rad", "angle by which the natural shape turns from root to tip"}};
}

std::vector<Hair> latin_hypercube(int count, std::uint64_t seed) {
  std::vector<std::vector<double>> u;
  for (std::uint64_t dimension = 0; dimension < 9; ++dimension) {
    u.push_back(coordinate(count, seed, dimension));
  }
  std::vector<Hair> all;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    all.push_back({.number = static_cast<int>(i) + 1,
                   .length = lengths.at(u[0][i]),
                   .radius = radii.at(u[1][i]),
                   .youngs_modulus = moduli.log_at(u[2][i]),
                   .ellipticity = ellipticities.at(u[3][i]),
                   .natural_curvature = curvatures.at(u[4][i]),
                   .internal_friction = friction_at(u[5][i]),
                   .drive = static_cast<Drive>(drives * u[6][i]),
                   .level = u[7][i],
                   .frequency = frequencies.at(u[8][i])});
  }
  return all;
}

Hair straightened(Hair hair) {
  hair.natural_curvature = 0;
  return hair;
}

int elements_of(const Hair& hair) {
  return std::max(least_elements,
                  static_cast<int>(std::ceil(hair.winding() / most_winding)));
}

double wind_speed(const Hair& hair) { return winds.at(hair.level); }

Parameters parameters_of(const Hair& hair, std::string_view model, int elements) {
  Parameters p(setup_parameters(find_model(model)), "model " + std::string(model));
  p.set("elements", std::to_string(elements));
  p.set("length_m", text(hair.length));
  p.set("radius_m", text(hair.radius));
  p.set("youngs_modulus_pa", text(hair.youngs_modulus));
  p.set("density_kg_m3", text(density));
  p.set("gravity_m_s2", text(earth_gravity));
  p.set("ellipticity", text(hair.ellipticity));
  p.set("natural_curvature_1_m", text(hair.natural_curvature));
  p.set("natural_twist_1_m", text(twist_per_curvature * hair.natural_curvature));
  p.set("internal_friction_kg_m3_s", text(hair.internal_friction));
  p.set("root_tangent", "x");
  p.set("initial", "natural");
  p.set("frequency_hz", text(hair.frequency));
  if (hair.drive == Drive::shake) {
    p.set("motion", "shake");
    p.set("amplitude_m", text(amplitudes.at(hair.level)));
  } else if (hair.drive == Drive::turning_head) {
    p.set("motion", "rotate");
    p.set("angle_rad", text(angles.at(hair.level)));
  }
  return p;
}

namespace {

Effects effects_of(const Hair& hair, const Parameters& p) {
  Effects effects = strand_effects(p);
  if (hair.drive == Drive::wind) effects.push_back(make_wind(wind_of(hair), {}));
  return effects;
}

}  // namespace

std::unique_ptr<System> make_system(const Hair& hair, std::string_view model,
                                    int elements, std::string_view modes) {
  Parameters p = parameters_of(hair, model, elements);
  set_known(p, {{"modes", modes}});
  return find_model(model).on_strand(strand(p), p, effects_of(hair, p));
}

Guard make_guard(const Hair& hair, std::string_view model, int elements, System& system) {
  const Parameters p = parameters_of(hair, model, elements);
  return {system, {guarded_strand(strand(p), effects_of(hair, p))}};
}

}  // namespace tress::experiments::family
