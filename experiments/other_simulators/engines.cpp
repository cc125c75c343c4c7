// Which engines this build has: CMake defines TRESS_OTHER_SIMULATORS_<NAME> as the
// version it found.
#include <vector>

#include "experiments/other_simulators/simulator.h"

namespace tress::experiments::other_simulators {

std::span<const Engine> engines() {
  static const std::vector<Engine> found = {
#ifdef TRESS_OTHER_SIMULATORS_SIMBODY
      {"simbody", TRESS_OTHER_SIMULATORS_SIMBODY, simbody_methods(), simbody_rubbing()},
#endif
#ifdef TRESS_OTHER_SIMULATORS_BULLET
      {"bullet", TRESS_OTHER_SIMULATORS_BULLET, bullet_methods(), bullet_rubbing()},
#endif
#ifdef TRESS_OTHER_SIMULATORS_MUJOCO
      {"mujoco", TRESS_OTHER_SIMULATORS_MUJOCO, mujoco_methods(), mujoco_rubbing()},
#endif
#ifdef TRESS_OTHER_SIMULATORS_ODE
      {"ode", TRESS_OTHER_SIMULATORS_ODE, ode_methods(), ode_rubbing()},
#endif
#ifdef TRESS_OTHER_SIMULATORS_MUJOCO_3
      {"mujoco_3", TRESS_OTHER_SIMULATORS_MUJOCO_3, mujoco_3_methods(), {}},
#endif
#ifdef TRESS_OTHER_SIMULATORS_JOLT
      {"jolt", TRESS_OTHER_SIMULATORS_JOLT, jolt_methods(), {}},
#endif
  };
  return found;
}

std::span<const std::string_view> missing() {
  static const std::vector<std::string_view> packages = {
#ifndef TRESS_OTHER_SIMULATORS_SIMBODY
      "libsimbody-dev",
#endif
#ifndef TRESS_OTHER_SIMULATORS_BULLET
      "libbullet-dev",
#endif
#ifndef TRESS_OTHER_SIMULATORS_MUJOCO
      "libmujoco-dev",
#endif
#ifndef TRESS_OTHER_SIMULATORS_ODE
      "libode-dev",
#endif
#ifndef TRESS_OTHER_SIMULATORS_MUJOCO_3
      "@mujoco/mujoco (npm)",
#endif
#ifndef TRESS_OTHER_SIMULATORS_JOLT
      "jolt-physics (npm)",
#endif
  };
  return packages;
}

}  // namespace tress::experiments::other_simulators
