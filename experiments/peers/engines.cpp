// Which engines this build has: CMake defines TRESS_PEERS_<NAME> as the version it found.
#include <vector>

#include "experiments/peers/peer.h"

namespace tress::experiments::peers {

std::span<const Engine> engines() {
  static const std::vector<Engine> found = {
#ifdef TRESS_PEERS_SIMBODY
      {"simbody", TRESS_PEERS_SIMBODY, simbody_methods(), simbody_rubbing()},
#endif
#ifdef TRESS_PEERS_BULLET
      {"bullet", TRESS_PEERS_BULLET, bullet_methods(), bullet_rubbing()},
#endif
#ifdef TRESS_PEERS_MUJOCO
      {"mujoco", TRESS_PEERS_MUJOCO, mujoco_methods(), mujoco_rubbing()},
#endif
#ifdef TRESS_PEERS_ODE
      {"ode", TRESS_PEERS_ODE, ode_methods(), ode_rubbing()},
#endif
#ifdef TRESS_PEERS_MUJOCO_3
      {"mujoco_3", TRESS_PEERS_MUJOCO_3, mujoco_3_methods(), {}},
#endif
#ifdef TRESS_PEERS_JOLT
      {"jolt", TRESS_PEERS_JOLT, jolt_methods(), {}},
#endif
  };
  return found;
}

std::span<const std::string_view> missing() {
  static const std::vector<std::string_view> packages = {
#ifndef TRESS_PEERS_SIMBODY
      "libsimbody-dev",
#endif
#ifndef TRESS_PEERS_BULLET
      "libbullet-dev",
#endif
#ifndef TRESS_PEERS_MUJOCO
      "libmujoco-dev",
#endif
#ifndef TRESS_PEERS_ODE
      "libode-dev",
#endif
#ifndef TRESS_PEERS_MUJOCO_3
      "@mujoco/mujoco (npm)",
#endif
#ifndef TRESS_PEERS_JOLT
      "jolt-physics (npm)",
#endif
  };
  return packages;
}

}  // namespace tress::experiments::peers
