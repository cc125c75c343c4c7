#pragma once

#include <string>

#include "contract/layers.h"

namespace tress::experiments::divided_heads {

/// Hairs by area of a scalp (1/m^2): some 110 000 on the 650 cm^2 of a person's.
inline constexpr double hair_density = 1.7e6;

/// The angle of a cap of the head, a sphere, from its middle to its border, on which so
/// many hairs are as dense.
double cap_angle(int strands);

/// The text of a scene of so many short hairs on a cap of a head that is shaken; what
/// touches are hairs nearer to each other than 1 mm.
std::string scene(bool touch, int strands);

}  // namespace tress::experiments::divided_heads
