#pragma once

#include <string>

#include "contract/layers.h"

namespace tress::experiments::divided_heads {

/// Hairs by area of a scalp (1/m^2): about 110 000 on the 650 cm^2 of a person's.
inline constexpr double hair_density = 1.7e6;

/// The angle of a cap of the head, a sphere, from its middle to its border, on which
/// this number of hairs has that density.
double cap_angle(int strands);

/// Returns the text of a scene of `strands` short hairs on a cap of a shaken head.
/// Hairs nearer to each other than 1 mm touch.
std::string scene(bool touch, int strands);

}  // namespace tress::experiments::divided_heads
