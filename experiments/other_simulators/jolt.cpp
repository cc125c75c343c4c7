// Jolt Physics, of which Debian has no package: its makers' npm package, run by node.
#include <fmt/format.h>

#include <numbers>

#include "experiments/other_simulators/simulator.h"
#include "experiments/other_simulators/swing_in_node.h"

namespace tress::experiments::other_simulators {
namespace {

std::unique_ptr<Simulator> make(const Swing& swing, double dt) {
  constexpr double area = std::numbers::pi * Swing::radius * Swing::radius;
  const std::string first = fmt::format(
      R"({{"links":{},"length":{},"mass":{},"moment":{},"hinge":{},"stretch":{},)"
      R"("damping":{},"dt":{}}})",
      swing.links, swing.link_length(), swing.mass(), swing.moment(), swing.stiffness(1),
      Swing::young * area / swing.link_length(), Swing::damping, dt);
  constexpr double at_start = 0;  // of a step
  return swing_in_node(TRESS_OTHER_SIMULATORS_FOLDER "/jolt.mjs", first, dt, at_start);
}

constexpr Method methods[] = {
    {"Cosserat rods, one sweep a step", 1, make, Precision::single}};

}  // namespace

std::span<const Method> jolt_methods() { return methods; }

}  // namespace tress::experiments::other_simulators
