#pragma once

#include <span>

#include "math/vec3.h"
#include "models/contact/box_pairs.h"

namespace tress::models {

/// What bounds need to know of a straight piece whose ends move straight on during a
/// step: its middle and half of its edge at half of the step, how its middle moves, and
/// how much farther its ends do.
struct PieceMotion {
  PieceMotion() = default;
  PieceMotion(const Vec& from0, const Vec& to0, const Vec& from1, const Vec& to1);
  Vec middle, half, moved;  // m
  double turned = 0;        // m
};

/// Tells the distance (m) that the two pieces of each pair keep at least during the step:
/// that at half of it, less how far they move relative to each other until its ends. NaN
/// if one is not finite. By lanes, about 10 ns a pair.
void least_approaches(std::span<const PieceMotion> motion,
                      std::span<BoxPairs::Pair> pairs);

}  // namespace tress::models
