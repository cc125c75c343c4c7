// MuJoCo 3, of which Debian 12 has no package: its makers' npm package, run by node.
#include <fmt/format.h>

#include "experiments/other_simulators/mujoco_strand.h"
#include "experiments/other_simulators/simulator.h"
#include "experiments/other_simulators/swing_in_node.h"

namespace tress::experiments::other_simulators {
namespace {

// Where the middle of a step counts, and not its start, damping is split off too.
constexpr double at_start = 0, at_middle = 0.5;

std::unique_ptr<Simulator> make(const Swing& swing, double dt, MujocoJoint joint,
                                std::string_view integrator, double phase) {
  const std::string first = fmt::format(
      R"({{"model":"{}","links":{},"length":{},"damping":{},"dt":{},"split":{}}})",
      mujoco_strand(swing, dt, joint, integrator), swing.links, swing.link_length(),
      Swing::damping, dt, phase == at_middle);
  return swing_in_node(TRESS_OTHER_SIMULATORS_FOLDER "/mujoco_3.mjs", first, dt, phase);
}

using enum MujocoJoint;
constexpr Method methods[] = {
    {"ball joints: Euler", 1,
     [](const Swing& s, double dt) { return make(s, dt, ball, "Euler", at_start); }},
    {"universal joints: Euler", 1,
     [](const Swing& s, double dt) { return make(s, dt, universal, "Euler", at_start); }},
    {"universal joints: implicitfast", 1,
     [](const Swing& s, double dt) {
       return make(s, dt, universal, "implicitfast", at_start);
     }},
    {"ball joints: RK4, damping split", 2,
     [](const Swing& s, double dt) { return make(s, dt, ball, "RK4", at_middle); }},
};

}  // namespace

std::span<const Method> mujoco_3_methods() { return methods; }

}  // namespace tress::experiments::other_simulators
