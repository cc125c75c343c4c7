#include <cmath>
#include <numbers>

#include "experiments/hard_cases/gauges.h"
#include "experiments/problems/strand_scenes.h"
#include "models/effects/tether.h"

namespace tress::experiments::hard_cases {
namespace {

constexpr std::string_view within_reach =
    "the tip stays within 1.001 lengths of the root, and is slower than the work of the "
    "root can make the last tenth of the strand";

/// Euler's load of a clamped strand with a free end, pi^2 EI/(2 L)^2, N.
double euler_load(const Strand& strand) {
  const double bending =
      strand.material.youngs_modulus * strand.segments.front().section.inertia1();
  return std::pow(std::numbers::pi / (2 * strand.length()), 2) * bending;
}

constexpr double overload = 10;  // multiple of Euler's buckling load

/// Pulled down at the tip, by a target so distant that its direction is constant.
void press_down(const Strand& strand, Effects& effects) {
  effects.push_back(
      std::make_shared<Tether>(Tether::Settings{.pull = overload * euler_load(strand),
                                                .target = {0, 0, -1e3},
                                                .off = never_off,
                                                .ramp = 0.1}));
}

/// Returns bounds for the pull P, which does work of at most P 2 L. The strand's root
/// mean square speed is u = sqrt(4 P L/m), and sqrt(30) u that of its tip
/// (strand_speed_bound).
StabilityBounds pressed_bounds(const Situation& s, double) {
  const double pull = overload * euler_load(s.strand);
  return {.reach = 1.001 * s.length,
          .speed = std::sqrt(30 * 4 * pull * s.length / s.mass)};
}

/// One of the middle segments is bent to a half circle, with the halves side by side.
void fold(Strand& strand) {
  Segment& middle = strand.segments[strand.segments.size() / 2];
  middle.initial = {0, std::numbers::pi / middle.length, 0};
}

/// A straight strand turns about its fixed middle.
void centre(Strand& strand) {
  FreeRoot& root = *strand.free_root;
  root.velocity = (strand.length() / 2) * cross(root.frame.e0, root.spin);
}

/// Alternating steps of dt and dt/100.
std::vector<double> jumping(double dt, double t_end) {
  constexpr double ratio = 100;
  std::vector<double> stops;
  for (double t = 0; t < t_end;) {
    t += stops.size() % 2 == 0 ? dt / ratio : dt;
    stops.push_back(t);
  }
  return stops;
}

}  // namespace

std::vector<HardCase> motion_cases() {
  std::vector<HardCase> all;
  all.push_back({.name = "violent_shake",
                 .why =
                     "root shaken by 5 cm at 3 Hz, no damping at all: what the strand is "
                     "given stays in it",
                 .measure = "bound_used",
                 .criterion = within_reach,
                 .settings = find_strand_scene("shake").settings,
                 .t_end = 0.7,
                 .bounds = driven_bounds});
  all.push_back({.name = "root_stop",
                 .why = "root stops from 5 m/s in 1 ms: within one step, which sees none "
                        "of it or all; the strand has energy to coil up many times",
                 .measure = "bound_used",
                 .criterion = within_reach,
                 .settings = {{"motion", "stop"},
                              {"root_tangent", "down"},
                              {"speed_m_s", "5"},
                              {"time_s", "1e-3"}},
                 .t_end = 0.2,
                 .horizon = 0.01,
                 .reference_step = 2e-5,
                 .bounds = driven_bounds});
  all.push_back({.name = "buckling",
                 .why =
                     "upright, pressed on its tip by up to ten times Euler's load: the "
                     "straight shape becomes unstable on the way",
                 .measure = "bound_used",
                 .criterion = within_reach,
                 .settings = {{"motion", "fixed"},
                              {"root_tangent", "up"},
                              {"gravity_m_s2", "0"},
                              {"initial", "bent"},
                              {"initial_curvature_per_m", "0.1"}},
                 .t_end = 0.4,
                 .reference_step = 1.25e-4,
                 .bounds = pressed_bounds,
                 .act = press_down});
  all.push_back({.name = "folded",
                 .why =
                     "folded on itself within one element: tangents are antipodal, which "
                     "no shortest rotation joins, and ten times the energy of a fall is "
                     "let go at once",
                 .measure = "energy_gain_over_bound",
                 .criterion = "the energy rises by less than 1 % of what the fold and "
                              "falling can turn into motion",
                 .settings = {{"motion", "fixed"}, {"root_tangent", "x"}},
                 .t_end = 0.1,
                 .horizon = 0.005,
                 .reference_step = 1e-5,
                 .bounds = passive_bounds,
                 .shape = fold});
  all.push_back(
      {.name = "million_steps",
       .why = "a million steps of a free, spinning strand: what every step adds, "
              "adds up (--quick: five thousand)",
       .measure = "growth_rel",
       .criterion = "neither energy nor angular momentum grows by more than 1 %; "
                    "accurate if both momenta keep their vectors to 5 %",
       .limit = 0.01,
       .settings = {{"motion", "free"}, {"elements", "2"}, {"gravity_m_s2", "0"}},
       .count = 1'000'000,
       .horizon = 0,
       .bounds = no_bounds,
       .gauge = momentum_gauge,
       .shape = centre});
  all.push_back({.name = "step_jumps",
                 .why =
                     "steps of dt and dt/100 in turn: methods with a memory must weigh "
                     "it anew, Newton's first guesses are off",
                 .measure = "energy_gain_over_bound",
                 .criterion = "the energy rises by less than 1 % of what falling can "
                              "turn into motion: nothing but gravity does work",
                 .settings = {{"motion", "fixed"}, {"root_tangent", "x"}},
                 .bounds = passive_bounds,
                 .stops = jumping});
  return all;
}

}  // namespace tress::experiments::hard_cases
