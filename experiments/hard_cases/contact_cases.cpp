#include <numbers>

#include "experiments/hard_cases/gauges.h"
#include "models/effects/body.h"
#include "models/effects/exact_body.h"
#include "models/effects/self_contact.h"
#include "models/effects/tether.h"

namespace tress::experiments::hard_cases {
namespace {

constexpr double touch = 1.2e-3, separation = 0.02;  // m, of the coil's turns

/// By 2.5 times the force that closes the coil, k = GJ/(L R^2) [Love] over the 1.2 mm
/// that its 3.2 turns can close.
void pull_coil(const Strand&, Effects& effects) {
  effects.push_back(std::make_shared<Tether>(
      Tether::Settings{.pull = 5e-6, .target = {}, .off = never_off, .ramp = 0.05}));
}

/// Turns 1.6 mm apart are pressed together until they touch, at 1.2 mm. The pull drives
/// them to 0.3 m/s at most, which the contact stops within v sqrt(rho A/K) = 0.2 mm, a
/// third of full penetration.
void close_coil(const Strand& strand, Effects& effects) {
  effects.push_back(std::make_shared<SelfContact>(
      ContactLaw(
          {.stiffness = 10, .viscosity = 1e-3, .inner = touch, .outer = 1.5 * touch},
          "case coil_contact"),
      separation));
  pull_coil(strand, effects);
}

StabilityBounds coil_bounds(const Situation& s, double) {
  return {.reach = 1.001 * s.length};
}

enum class Friction { regularised, exact };

std::shared_ptr<const Effect> plane(const Vec& at, const Vec& axis, double angle,
                                    const BodyContact& law, Friction friction) {
  const StrandPlace place{at, rotation(axis, angle)};
  if (friction == Friction::regularised) {
    return std::make_shared<Body>(Plane{}, place, law);
  }
  return std::make_shared<ExactBody>(Plane{}, place,
                                     ExactContact{law.normal(), true, law.friction});
}

constexpr double radius = 40e-6;  // m, of the strand
constexpr BodyContact floor_contact{
    .stiffness = 1e3, .damping = 1, .friction = 0.3, .offset = radius};
constexpr BodyContact cone_contact{
    .stiffness = 1e5, .damping = 1, .friction = 0.5, .offset = radius};

/// Tilted by 5 degrees across the path of the root, which drags the strand along it.
template <Friction friction>
void slope(const Strand&, Effects& effects) {
  effects.push_back(plane({0, 0, -5e-3}, {1, 0, 0}, 5 * std::numbers::pi / 180,
                          floor_contact, friction));
}

/// Three planes at 45 degrees that meet below the middle of the strand.
template <Friction friction>
void cone(const Strand& strand, Effects& effects) {
  const Vec apex{strand.length() / 2, 0, -0.06};
  for (int side = 0; side < 3; ++side) {
    const double around = side * 2 * std::numbers::pi / 3;
    const Vec level{-std::sin(around), std::cos(around), 0};
    effects.push_back(plane(apex, level, -std::numbers::pi / 4, cone_contact, friction));
  }
}

/// 1 % of the fall of the strand to the apex.
StabilityBounds cone_bounds(const Situation& s, double) {
  constexpr double depth = 0.06;
  return {.energy = 0.01 * s.mass * s.parameters.number("gravity_m_s2") * depth};
}

/// The same motion under Coulomb's law itself.
HardCase with_exact_friction(HardCase given, std::string_view name, std::string_view why,
                             decltype(HardCase::act) act) {
  given.name = name;
  given.why = why;
  given.act = act;
  return given;
}

/// The same, with forces that are found after the step of the strand alone.
HardCase by_impulses(HardCase given, std::string_view name, ModelSettings law) {
  given.name = name;
  given.why =
      "the same law by impulses at the end of the step, of which the strand's own step "
      "knows nothing: one linear solve is enough for it, and for linearly implicit Euler";
  given.impulses = std::move(law);
  return given;
}

}  // namespace

std::vector<HardCase> contact_cases() {
  std::vector<HardCase> all;
  all.push_back({.name = "coil_contact",
                 .why = "a coil is pulled together until its turns lie on each other: "
                        "contacts all along, which come and go, and couple points "
                        "that are far from each other along the strand",
                 .measure = "overlap_over_radius",
                 .criterion =
                     "turns overlap by less than their radius, so that they have not "
                     "passed through each other; the tip stays within reach of the root",
                 .settings = {{"motion", "fixed"},
                              {"root_tangent", "x"},
                              {"elements", "20"},
                              {"gravity_m_s2", "0"},
                              {"natural_curvature_per_m", "200"},
                              {"natural_twist_per_m", "10"},
                              {"internal_friction_kg_m3_s", "1e-10"}},
                 .t_end = 0.15,
                 .horizon = 0.08,
                 .bounds = coil_bounds,
                 .gauge = [](const Situation& s) -> std::unique_ptr<Gauge> {
                   return std::make_unique<OverlapGauge>(s, touch, separation);
                 },
                 .act = close_coil});
  all.push_back(by_impulses(all.back(), "coil_impulse", {{"thickness_m", "1.2e-3"}}));
  all.back().act = pull_coil;
  all.back().horizon = 0;
  all.push_back({.name = "grazing_contact",
                 .why =
                     "a strand comes upon a plane at 5 degrees and 0.3 m/s, sliding with "
                     "friction: 1/30 s moves it by a hundred of its diameters along "
                     "the plane, and by ten into it",
                 .measure = "penetration_over_bound",
                 .criterion = "no point is deeper than the radius of the strand and the "
                              "part of the tip beyond the last quadrature point; reach "
                              "and speed are bounded as for driven roots",
                 .settings = {{"motion", "swing"},
                              {"root_tangent", "x"},
                              {"gravity_m_s2", "0"},
                              {"amplitude_m", "0.025"},
                              {"frequency_hz", "2"},
                              {"natural_curvature_per_m", "0.8"}},
                 .horizon = 0.2,
                 .bounds = driven_bounds,
                 .gauge = penetration_gauge,
                 .act = slope<Friction::regularised>});
  all.push_back(with_exact_friction(
      all.back(), "grazing_exact",
      "the same with exact friction: what sticks or turns round does so within a step",
      slope<Friction::exact>));
  all.push_back(by_impulses(all.back(), "grazing_impulse", {}));
  all.push_back(
      {.name = "cone",
       .why = "a free strand falls into a cone of three planes with friction 0.5: "
              "ends hit head-on, and what sticks below 1 mm/s turns round "
              "within one of Newton's steps at 0.3 m/s",
       .measure = "penetration_over_bound",
       .criterion = "no point is deeper than the radius of the strand and the part of "
                    "the tip beyond the last quadrature point; the energy rises by less "
                    "than 1 % of the fall to the apex",
       .settings = {{"motion", "free"}, {"root_tangent", "x"}, {"spin_rad_s", "0"}},
       .t_end = 0.2,
       .horizon = 0.08,
       .bounds = cone_bounds,
       .gauge = penetration_gauge,
       .act = cone<Friction::regularised>});
  all.push_back(with_exact_friction(
      all.back(), "cone_exact",
      "the same with exact friction: ends hit head-on, and all that is in contact may "
      "stick or slip",
      cone<Friction::exact>));
  all.push_back(by_impulses(all.back(), "cone_impulse", {}));
  return all;
}

}  // namespace tress::experiments::hard_cases
