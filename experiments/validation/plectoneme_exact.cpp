#include <cmath>
#include <numbers>
#include <stdexcept>

#include "contract/parameters.h"
#include "experiments/validation/plectoneme.h"
#include "experiments/validation/rods/motion.h"
#include "experiments/validation/rods/touching.h"

namespace tress::experiments::validation {
namespace {

constexpr double turns = 12, more_turns = 4, twisting = 2;  // of the clamp, s
constexpr double dt = 2e-3;                                 // s

/// Its effects, and its plies at the distance of those of `plectoneme`.
simulation::Scene exact_thread(const ModelVariant& variant, const HeldThread& thread,
                               double friction, double step) {
  std::vector<EffectSettings> effects;
  const auto elements = static_cast<double>(thread.strand.segments.size());
  for (const HeldThread::Hand& hand : thread.hands) {
    const Vec& x = hand.place;
    effects.push_back({"tether",
                       {{"at", number_text(hand.node / elements)},
                        {"stiffness_n_m", number_text(HeldThread::stiffness)},
                        {"target_m", number_text(x.x) + "," + number_text(x.y) + "," +
                                         number_text(x.z)},
                        {"t_off_s", "1e6"}}});
  }
  effects.push_back({"linear_drag", {{"drag_kg_m_s", "1e-3"}}});
  // A ply that turns moves at some centimetres a second.
  effects.push_back({"strand_friction",
                     {{"friction", number_text(friction)},
                      {"thickness_m", number_text(2 * HeldThread::ply_radius)},
                      {"tolerance_m_s", "1e-5"}}});
  // One linear solve a step, as `plectoneme`.
  return touching_strands(variant, {thread.strand}, effects, step,
                          "linearly_implicit_euler");
}

void proceed(simulation::World& world, double t, const Deadline& deadline,
             const ContactRun& run = {}) {
  go_on(world, t, run);
  if (deadline.passed()) throw std::runtime_error("the time for the row was over");
}

double measured_angle(const ModelTrial& trial) {
  const HeldThread thread = held_thread(trial.variant, trial.elements, turns);
  simulation::World world(exact_thread(trial.variant, thread, trial.parameter, dt));
  for (int i = 1; i <= 100; ++i) {
    proceed(world, thread.settled * i / 100, trial.deadline, trial.contact);
  }
  return thread.angle_over_equilibrium(world.positions());
}

}  // namespace

TwistWork twist_on_and_back(const ModelVariant& variant, int elements, double friction,
                            double step, const Deadline& deadline) {
  HeldThread thread = held_thread(variant, elements, turns);
  const double most = 2 * std::numbers::pi * more_turns;
  const Signal on = smooth_step(most, thread.settled, twisting);
  const Signal back = smooth_step(-most, thread.settled + twisting, twisting);
  for (const Signal& signal : {on, back}) {
    thread.strand.root.rotations.push_back({{1, 0, 0}, signal});
  }
  simulation::World world(exact_thread(variant, thread, friction, step));
  proceed(world, thread.settled, deadline);
  const auto moment = [&] { return thread.moment(world.positions()); };
  const auto work = [&](double from, const Signal& turned) {
    double sum = 0, before = moment();
    const auto steps = static_cast<int>(std::lround(twisting / step));
    for (int i = 1; i <= steps; ++i) {
      const double t0 = from + (i - 1) * step, t1 = from + i * step;
      proceed(world, t1, deadline);
      const double now = moment();
      sum += (before + now) / 2 * (turned(t1).value - turned(t0).value);
      before = now;
    }
    return sum;
  };
  const double given = work(thread.settled, on);
  return {given, -work(thread.settled + twisting, back)};
}

std::vector<ValidationTest> plectoneme_exact_tests() {
  ValidationTest test = plectoneme_tests().front();
  test.name = "plectoneme_exact";
  test.what = "the same with exact contact and friction of its plies";
  test.parameter = "friction coefficient mu";
  test.quantity = "angle of the plies over that of the equilibrium without friction";
  test.range = {0, 0.05};
  test.quick = {{0}, {125}};
  test.usual = {{0, 0.05}, {125}};
  test.full = {{0, 0.02, 0.05}, {125, 250}};
  test.why =
      "as `plectoneme`; with friction a ply rests between the angle at which it would "
      "wind on and the one at which it would unwind, some mu apart";
  test.measure = measured_angle;
  return {test};
}

}  // namespace tress::experiments::validation
