#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "contract/constants.h"
#include "experiments/family/family.h"
#include "experiments/family/sampling.h"
#include "experiments/problems/strand_models.h"
#include "models/catalogue.h"
#include "models/effects/air_law.h"
#include "models/effects/wind.h"
#include "models/strand/strand_parameters.h"

namespace tress::experiments::family {
namespace {

constexpr int least_elements = 20;
constexpr double most_winding = 1.5;  // rad per element
constexpr double head_radius = 0.1;   // m

// A head that turns stays below 2.6 Hz and 13.6 rad/s, the medians of vigorous shaking
// [Grossman et al. 1988]; the angles here reach 13.6 rad/s at 2.6 Hz. Those of a shake,
// and the wind, are chosen: up to 10 m/s is a fresh breeze.
constexpr Range amplitudes{0.01, 0.05}, angles{0.2, 0.83}, winds{0.5, 10};

double amplitude(const Rod& rod) { return amplitudes.at(rod.level); }
double angle(const Rod& rod) { return angles.at(rod.level); }

std::string text(double x) { return fmt::format("{}", x); }

Parameters wind_of(const Rod& rod) {
  Parameters wind(wind_parameters(), "effect wind");
  wind.set("velocity_m_s", fmt::format("0,{},0", wind_speed(rod)));
  wind.set("profile", "sine");
  wind.set("frequency_hz", text(rod.frequency));
  wind.set("drag_kg_m_s", text(rod.drag));
  return wind;
}

}  // namespace

std::string_view name(Family family) { return family == Family::hair ? "hair" : "rods"; }

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

double Rod::mass_per_length() const {
  return density * std::numbers::pi * radius * radius;
}

double Rod::bending_stiffness() const {
  return youngs_modulus * std::numbers::pi / 4 * std::pow(radius, 4);
}

double Rod::gravito_bending() const {
  return mass_per_length() * earth_gravity * std::pow(length, 3) / bending_stiffness();
}

double Rod::winding() const {
  return std::hypot(natural_curvature, natural_twist) * length;
}

double Rod::air_speed() const {
  switch (drive) {
    case Drive::shake:
      return root_speed(*this);
    case Drive::turning_head:
      return root_speed(*this) * (head_radius + length / 2) / (head_radius + length);
    case Drive::release:
      return std::sqrt(earth_gravity * length);
    case Drive::wind:
      break;
  }
  return wind_speed(*this);
}

double air_drag(double radius, double speed) {
  constexpr double density = 1.2, viscosity = 1.8e-5;  // of air, kg/m^3 and Pa s
  return models::CylinderDrag{viscosity / 2, 2 * radius * density / viscosity}.value(
      speed);
}

double wind_speed(const Rod& rod) { return winds.log_at(rod.level); }

double root_speed(const Rod& rod) {
  const double omega = 2 * std::numbers::pi * rod.frequency;
  if (rod.drive == Drive::shake) return omega * amplitude(rod);
  if (rod.drive != Drive::turning_head) return 0;
  return omega * angle(rod) * (head_radius + rod.length);
}

void Rod::describe(Row& row) const {
  row.set("kind", kind).set("state", state);
  row.set("length_m", length).set("radius_m", radius);
  row.set("youngs_modulus_pa", youngs_modulus).set("shear_modulus_pa", shear_modulus);
  row.set("density_kg_m3", density).set("ellipticity", ellipticity);
  row.set("natural_curvature_per_m", natural_curvature);
  row.set("internal_friction_kg_m3_s", internal_friction);
  row.set("damping_time_s", internal_friction / bending_stiffness());
  row.set("drag_kg_m_s", drag);
  row.set("drive", name(drive)).set("drive_level", level).set("frequency_hz", frequency);
  row.set("gravito_bending", gravito_bending()).set("winding_rad", winding());
}

std::vector<Column> rod_columns() {
  return {{"kind", "group of the hair (straight, wavy, coily), or material of the rod"},
          {"state", "state of a hair: dry or wet"},
          {"length_m", "length of the rod"},
          {"radius_m", "radius of the section; of an ellipse the geometric mean"},
          {"youngs_modulus_pa", "Young's modulus E"},
          {"shear_modulus_pa", "shear modulus G"},
          {"density_kg_m3", "density"},
          {"ellipticity", "half-axis along e1 over half-axis along e2"},
          {"natural_curvature_per_m",
           "curvature at rest; twist at rest is 0.3 times the curvature for hair, 0 "
           "for other rods"},
          {"internal_friction_kg_m3_s", "friction of bending and twisting"},
          {"damping_time_s", "internal friction over E I"},
          {"drag_kg_m_s", "linear drag of air per length"},
          {"drive", "motion of the clamp, or load: shake, turning_head, release or wind"},
          {"drive_level", "strength of the drive between its least (0) and most (1)"},
          {"frequency_hz", "frequency of the drive"},
          {"gravito_bending", "gravito-bending number rho A g L^3/(E I)"},
          {"winding_rad", "angle by which the natural shape turns from root to tip"}};
}

Rod straightened(Rod rod) {
  rod.natural_curvature = rod.natural_twist = 0;
  return rod;
}

int elements_of(const Rod& rod) {
  return std::max(least_elements,
                  static_cast<int>(std::ceil(rod.winding() / most_winding)));
}

Parameters parameters_of(const Rod& rod, std::string_view model, int elements) {
  Parameters p(setup_parameters(find_model(model)), "model " + std::string(model));
  p.set("elements", std::to_string(elements));
  p.set("length_m", text(rod.length));
  p.set("radius_m", text(rod.radius));
  p.set("youngs_modulus_pa", text(rod.youngs_modulus));
  p.set("shear_modulus_pa", text(rod.shear_modulus));
  p.set("density_kg_m3", text(rod.density));
  p.set("gravity_m_s2", text(earth_gravity));
  p.set("ellipticity", text(rod.ellipticity));
  p.set("natural_curvature_per_m", text(rod.natural_curvature));
  p.set("natural_twist_per_m", text(rod.natural_twist));
  p.set("internal_friction_kg_m3_s", text(rod.internal_friction));
  if (rod.drive != Drive::wind) p.set("drag_kg_m_s", text(rod.drag));
  p.set("root_tangent", "x");
  p.set("initial", "natural");
  p.set("frequency_hz", text(rod.frequency));
  if (rod.drive == Drive::shake) {
    p.set("motion", "shake");
    p.set("amplitude_m", text(amplitude(rod)));
  } else if (rod.drive == Drive::turning_head) {
    p.set("motion", "rotate");
    p.set("head_radius_m", text(head_radius));
    p.set("angle_rad", text(angle(rod)));
  }
  return p;
}

namespace {

Effects effects_of(const Rod& rod, const Parameters& p) {
  Effects effects = strand_effects(p);
  if (rod.drive == Drive::wind) effects.push_back(make_wind(wind_of(rod), {}));
  return effects;
}

}  // namespace

std::unique_ptr<System> make_system(const Rod& rod, std::string_view model, int elements,
                                    std::string_view modes) {
  Parameters p = parameters_of(rod, model, elements);
  set_known(p, {{"modes", modes}});
  return find_model(model).on_strand(strand(p), p, effects_of(rod, p));
}

Guard make_guard(const Rod& rod, std::string_view model, int elements, System& system) {
  const Parameters p = parameters_of(rod, model, elements);
  return {system, {guarded_strand(strand(p), effects_of(rod, p))}};
}

}  // namespace tress::experiments::family
