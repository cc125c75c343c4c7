#pragma once

#include <string>
#include <string_view>

#include "experiments/other_simulators/simulator.h"

namespace tress::experiments::other_simulators {

enum class MujocoJoint { ball, universal };

/// The strand in MuJoCo's own format: links nested from the clamp outwards.
std::string mujoco_strand(const Swing& swing, double dt, MujocoJoint joint,
                          std::string_view integrator);

}  // namespace tress::experiments::other_simulators
