#include "experiments/validation/turned_ends.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "contract/input_error.h"
#include "experiments/validation/plectoneme.h"
#include "experiments/validation/rods/motion.h"
#include "experiments/validation/rods/numerics.h"
#include "experiments/validation/rods/touching.h"
#include "experiments/validation/rods/turned_rod.h"

namespace tress::experiments::validation {
namespace {

using std::numbers::pi;

constexpr double length = TurnedRod::length;
/// Shortening of the ends while the support turns: without any, an inextensible thread
/// could not buckle.
constexpr double slack = 0.002;

void proceed(simulation::World& world, double t, const Deadline& deadline) {
  go_on(world, t);
  if (deadline.passed()) throw std::runtime_error("the time for the row was over");
}

/// The support turns while the ends are 0.2 % closer than the thread is long: it bends
/// from the start, and stays close to the straight one. After another second its motion
/// has decayed by exp(-10): density and drag damp its first vibration (20/s) critically.
double moment_over_critical(const ModelTrial& trial) {
  constexpr double turning = 1, waiting = 1;
  const TurnedRod rod{.turns = trial.parameter,
                      .turning = turning,
                      .pushes = {{0, slack}, {turning + waiting, slack}},
                      .density = 1,
                      .drag = 2e-5,
                      .internal_friction = 1e-9,
                      .step = 4e-3};
  simulation::World world(rod.scene(trial.variant, trial.elements));
  constexpr double end = turning + waiting;
  proceed(world, 0.9 * end, trial.deadline);
  const TipLoad before = tip_load(world);
  proceed(world, end, trial.deadline);
  const TipLoad load = tip_load(world);
  const double moved =
      std::abs(load.tension - before.tension) / std::max(std::abs(load.tension), pi * pi);
  if (!(moved < 0.01)) throw std::runtime_error("it does not come to rest");
  return load.moment / twist_that_buckles(load.tension);
}

double rotation(double turns) { return 2 * pi * turns; }

/// Returns true if a thread that has left its equilibria turns over into a loop. The jump
/// takes some milliseconds, in steps of 0.1 ms.
bool jumps(TurnedRod rod, simulation::World& before, const ModelTrial& trial) {
  rod.step = 1e-4;
  simulation::World world(rod.scene(trial.variant, trial.elements));
  world.restore(before.snapshot());
  constexpr double most = 0.1, part = 1e-3;  // s
  for (double t = part; t < most; t += part) {
    proceed(world, before.time() + t, trial.deadline);
    // Equilibria with this tilt have less than 0.8 of the shortening.
    if (largest_tilt(world) > 3 * pi / 4) return world.stretch() < 0.01;
  }
  return false;
}

/// The support turns, comes to 0.9 of the shortening of the jump, and goes on slowly.
/// Returns the shortening at which some chord is across the axis. There the shortening of
/// equilibria is flat: 3 degrees of tilt before the jump change it by 0.2 %.
double measured_jump(const ModelTrial& trial) {
  constexpr double turning = 1, coming = 0.5, pushing = 3;
  const double jump =
      loop_jump(rotation(trial.parameter), TurnedRod::twist_over_bend).shortening;
  const TurnedRod rod{.turns = trial.parameter,
                      .turning = turning,
                      .pushes = {{0, slack},
                                 {turning, slack},
                                 {turning + coming, 0.9 * jump},
                                 {turning + coming + pushing, 1.06 * jump}},
                      .density = 0.1,
                      .drag = 6e-6,
                      .internal_friction = 1e-10,
                      .step = 4e-3};
  simulation::World world(rod.scene(trial.variant, trial.elements));
  double tilt = 0, shortening = 0, across = 0;
  while (world.time() + rod.step < rod.pushes.back().time) {
    proceed(world, world.time() + rod.step, trial.deadline);
    const double tilt_before = tilt, shortening_before = shortening;
    tilt = largest_tilt(world);
    shortening = 1 - point(world, 0, -1).x / length;
    if (!(shortening < 1.1 * jump)) throw std::runtime_error("it becomes unstable");
    if (tilt_before < pi / 2 && tilt >= pi / 2) {
      across = std::lerp(shortening_before, shortening,
                         (pi / 2 - tilt_before) / (tilt - tilt_before));
    }
    constexpr double beyond_equilibria = 100 * pi / 180;
    if (tilt < beyond_equilibria) continue;
    if (jumps(rod, world, trial)) return across;
    break;
  }
  throw std::runtime_error("it makes no loop");
}

/// As `plectoneme`, with the support in place of the handle.
double angle_over_equilibrium(const ModelTrial& trial) {
  constexpr double turning = 2, pushing = 2, waiting = 3;
  const TurnedRod rod{.turns = trial.parameter,
                      .turning = turning,
                      .pushes = {{0, slack},
                                 {turning, slack},
                                 {turning + pushing, 0.3},
                                 {turning + pushing + waiting, 0.3}},
                      .density = 1000,
                      .drag = 1e-3,
                      .contact_radius = HeldThread::ply_radius,
                      .step = 2e-3};
  simulation::World world(rod.scene(trial.variant, trial.elements));
  constexpr int parts = 100;
  for (int i = 1; i <= parts; ++i) {
    proceed(world, rod.pushes.back().time * i / parts, trial.deadline);
  }
  const Ply found = ply(world.positions(), length / trial.elements,
                        TurnedRod::separation(), 2.4 * HeldThread::ply_radius);
  const double tension = tip_load(world).tension;
  if (found.pairs == 0 || !(tension > 0)) {
    throw std::runtime_error("it makes no plectoneme");
  }
  return found.angle / ply_angle(tension * std::pow(found.radius / length, 2));
}

}  // namespace

double twist_that_buckles(double tension) {
  if (!(tension > -39)) {
    throw InputError("no twist buckles a rod that its thrust buckles", "tension",
                     "give more than -39 EI/L^2");
  }
  // At T = 0 the equation is true of every M. Next to it M changes by 0.15 T.
  constexpr double least = 1e-3;
  const double t = std::abs(tension) < least ? least : tension;
  const auto moment = [t](double d) { return std::sqrt(d * d + 4 * t); };
  const double d = find_root(
      [&](double x) {
        return x * (std::cos(x / 2) - std::cos(moment(x) / 2)) - t * std::sin(x / 2);
      },
      std::max(2 * pi, 2 * std::sqrt(std::max(-t, 0.0))), 4 * pi);
  return moment(d);
}

LoopJump loop_jump(double rotation, double twist_over_bend) {
  const double tilt = find_root(
      [rotation](double a) { return std::cos(a) * (rotation - 2 * a) + 2 * std::sin(a); },
      pi / 2, pi);
  return {tilt, 4 * std::sin(tilt) / (twist_over_bend * (rotation - 2 * tilt))};
}

std::vector<ValidationTest> turned_end_tests() {
  constexpr int elements = 80;
  const std::vector<std::string_view> with_twist = {
      "super_helix", "super_clothoid", "articulated_chain", "der",
      "corde",       "xpbd_cosserat",  "dynamic_spline"};
  return {
      {
          .name = "twist_buckling",
          .what = "straight strand between a clamp and a support that turns",
          .source = "Greenhill 1883; Love 1927, section 272: determinant of the "
                    "linearised equations",
          .parameter = "turns of the support",
          .quantity = "twisting moment over the one that buckles it at its tension",
          // Fewer turns leave it under thrust; more need more elements.
          .range = {2.2, 6},
          .quick = {{2.2, 6}, {elements}},
          .usual = {{2.2, 4, 6}, {40, elements}},
          .full = {{2.2, 3, 4, 5, 6}, {40, 57, elements, 113}},
          .tolerance = 0.03,
          .why = "sections turn by 0.47 rad per element at 6 turns. `der` averages the "
                 "frames of two edges: EI falls by 1 - cos^2(0.47/2) = 5.4 %, the moment "
                 "by half of that. The shortening of 0.2 % changes it by as much",
          .judged_from = elements,
          .claimed = with_twist,
          .reference = [](double) { return 1.0; },
          .refusal = no_twist,
          .measure = moment_over_critical,
      },
      {
          .name = "loop_jump",
          .what = "a twisted strand, pushed by its support, jumps into a loop",
          .source = "Coyne 1990; Neukirch, van der Heijden & Thompson 2002: closed form",
          .parameter = "turns of the support",
          .quantity = "shortening of the distance of the ends over L at the jump",
          .range = {5, 7},
          .quick = {{6}, {elements}},
          .usual = {{5, 6}, {elements}},
          .full = {{5, 6, 7}, {57, elements, 113}},
          .tolerance = 0.03,
          .why =
              "sections turn by 0.43 rad per element, the loop by 0.28 rad: strains of "
              "chords are off by 0.43^2/12 + 0.28^2/12 = 2 %. The speed of the push "
              "delays the jump by 0.4 %: at half of it by 0.25 %",
          .judged_from = elements,
          .claimed = with_twist,
          .reference =
              [](double turns) {
                return loop_jump(rotation(turns), TurnedRod::twist_over_bend).shortening;
              },
          .refusal = no_twist,
          .measure = measured_jump,
      },
      {
          .name = "plectoneme_supports",
          .what = "`plectoneme` with a support in place of the springs at its handle",
          .source = "Clauvelin, Audoly & Neukirch 2009",
          .parameter = "turns of the support",
          .quantity = "angle of the plies over that of the equilibrium",
          .range = {4, 30},
          .quick = {{12}, {100}},
          .usual = {{12}, {100}},
          .full = {{11, 12, 13}, {100}},
          .tolerance = 0.05,
          .why = "that of `plectoneme`",
          .judged_from = 100,
          .claimed = {"der", "corde", "xpbd_cosserat", "dynamic_spline"},
          .reference = [](double) { return 1.0; },
          .refusal = no_twist,
          // The snap takes them minutes, and a linear solve per step does not bring them
          // through it.
          .slow = {"super_helix", "super_clothoid", "articulated_chain",
                   "force_transport"},
          .measure = angle_over_equilibrium,
      },
  };
}

}  // namespace tress::experiments::validation
