// Stiff straight rods that rub on each other, by exact contact between strands
// (StrandFriction). Gravity is so small that they sag by 1e-4 of their length (Gamma =
// 0.01).
//
// Crossing: a rod lies across two others that lie on ice, and is thrown along them. The
// friction mu m g on it and on them lets their relative speed fall by 1.5 mu g a second,
// until all three move at a third of its speed.
//
// Pile: two rods side by side on the floor bear a third one. Friction acts on axes, so
// that rods do not roll. With N and T between two rods, and 3/2 m g under each lower one,
// 2 (N cos 30 + T sin 30) = m g and N sin 30 = T cos 30 + F: all at their limits for 3
// mu^2/2 + 2 sqrt(3) mu = 1/2.
#include "experiments/validation/rods/touching.h"

#include <cmath>
#include <stdexcept>

#include "contract/parameters.h"
#include "experiments/validation/rods/motion.h"
#include "experiments/validation/rods/numerics.h"
#include "experiments/validation/rods/rod.h"
#include "experiments/validation/test.h"

namespace tress::experiments::validation {
namespace {

const double touching_length = TestRod().length;
const double touching_gravity = TestRod().gravity(0.01);

Frame along(const Vec& tangent) {
  const Vec up{0, 0, 1};
  return {tangent, up, cross(tangent, up)};
}

Strand loose_rod(int elements, const Vec& root, const Vec& tangent,
                 const Vec& velocity = {}) {
  Strand strand = TestRod().strand(elements, along(tangent));
  strand.free_root = FreeRoot{root, along(tangent), velocity, {}};
  return strand;
}

std::vector<EffectSettings> on_floor(const ContactRun& run, double radius,
                                     double floor_friction, double friction) {
  return {{"gravity", {{"gravity_m_s2", "0,0," + number_text(-touching_gravity)}}},
          {"body",
           {{"friction_law", "exact"},
            {"normal", run.is_rigid(true) ? "rigid" : "compliant"},
            {"friction", number_text(floor_friction)},
            {"strand_radius_m", number_text(radius)}}},
          {"strand_friction",
           {{"friction", number_text(friction)},
            {"own", "no"},
            {"tolerance_m_s",
             number_text(1e-9 * std::sqrt(touching_length * touching_gravity))},
            {"sweeps", "2000"}}}};
}

/// By how much of g the relative speed falls.
double slowed(const ModelTrial& trial) {
  const double length = touching_length, g = touching_gravity;
  const double way = 0.2 * length, speed = std::sqrt(2 * 1.5 * trial.parameter * g * way);
  const double stop = speed / (1.5 * trial.parameter * g), dt = stop / 400;
  std::vector<Strand> strands;
  for (const double side : {-0.25, 0.25}) {
    strands.push_back(loose_rod(trial.elements, {0, side * length, 0}, {1, 0, 0}));
  }
  const double radius = strands.front().segments.front().section.a1;
  for (Strand& rail : strands) rail.free_root->position.z = radius;
  strands.push_back(loose_rod(trial.elements, {0.3 * length, -0.5 * length, 3 * radius},
                              {0, 1, 0}, {speed, 0, 0}));
  simulation::World world(touching_strands(
      trial.variant, strands, on_floor(trial.contact, radius, 0, trial.parameter), dt,
      trial.contact.integrator));
  const auto apart = [&] {
    return point(world, 2, trial.elements / 2).x - point(world, 0, 0).x;
  };
  const auto relative_speed = [&](double t) {
    go_on(world, t, trial.contact);
    const double before = apart();
    go_on(world, t + dt, trial.contact);
    return (apart() - before) / dt;
  };
  const double first = relative_speed(0.1 * stop), last = relative_speed(0.8 * stop);
  const double slower = (first - last) / (0.7 * stop * g);
  if (std::abs(relative_speed(1.5 * stop)) > 1e-5 * speed) {
    throw std::runtime_error("they do not stick together");
  }
  return slower;
}

bool pile_falls(const ModelTrial& trial, double friction) {
  std::vector<Strand> strands(3, loose_rod(trial.elements, {}, {1, 0, 0}));
  const double radius = strands.front().segments.front().section.a1;
  strands[0].free_root->position = {0, -radius, radius};
  strands[1].free_root->position = {0, radius, radius};
  strands[2].free_root->position = {0, 0, (1 + std::sqrt(3.0)) * radius};
  // Falls with the part of g by which friction is too little.
  const double t_end = 30 * std::sqrt(radius / touching_gravity);
  simulation::World world(touching_strands(
      trial.variant, strands, on_floor(trial.contact, radius, friction, friction),
      t_end / 300, trial.contact.integrator));
  const double start = point(world, 2, 0).z;
  for (int i = 1; i <= 30; ++i) {
    go_on(world, t_end * i / 30, trial.contact);
    if (start - point(world, 2, 0).z > 0.1 * radius) return true;
  }
  return false;
}

const double least_of_pile = (std::sqrt(15.0) - 2 * std::sqrt(3.0)) / 3;

double measured_pile(const ModelTrial& trial) {
  if (!pile_falls(trial, 0.8 * least_of_pile)) {
    throw std::runtime_error("holds with much less friction");
  }
  if (pile_falls(trial, 1.2 * least_of_pile)) {
    throw std::runtime_error("falls against much more friction");
  }
  return threshold([&](double friction) { return !pile_falls(trial, friction); },
                   0.8 * least_of_pile, 1.2 * least_of_pile, 2e-3);
}

}  // namespace

std::vector<ValidationTest> touching_tests() {
  const std::vector<std::string_view> claimed = {"super_helix", "super_clothoid",
                                                 "der",         "corde",
                                                 "mass_spring", "inextensible_strand"};
  return {{
              .name = "crossing",
              .what = "a rod thrown along two rods on ice drags them, and sticks to them",
              .source = "Coulomb's law and momentum of three bodies",
              .parameter = "friction coefficient mu between rods",
              .quantity = "fall of their relative speed over g and time",
              .range = {0.01, 1},
              .quick = {{0.3}, {8}},
              .usual = {{0.1, 0.3, 0.5}, {8}},
              .full = {{0.1, 0.3, 0.5, 0.8}, {8, 16}},
              .tolerance = 0.001,
              .why = "rods sag by 1e-4 L and vibrate by as much",
              .judged_from = 8,
              .claimed = claimed,
              .reference = [](double friction) { return 1.5 * friction; },
              .measure = slowed,
          },
          {
              .name = "pile",
              .what = "two rods on the floor bear a third if friction is large enough",
              .source = "statics of three rods that do not roll",
              .parameter = "gravity, Gamma",
              .quantity = "least friction coefficient that holds",
              .range = {0.01, 0.01},
              .quick = {{0.01}, {4}},
              .usual = {{0.01}, {4}},
              .full = {{0.01}, {4, 8}},
              .tolerance = 0.01,
              .why = "0.1 % of the search, and a pile that has sunk by 10 % of a radius "
                     "has fallen",
              .judged_from = 4,
              .claimed = claimed,
              .reference = [](double) { return least_of_pile; },
              .measure = measured_pile,
          }};
}

}  // namespace tress::experiments::validation
