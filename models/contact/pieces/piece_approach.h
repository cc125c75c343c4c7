#pragma once

#include <span>

#include "math/vec3.h"
#include "models/contact/box_pairs.h"

namespace tress::models {

/// Motion of a straight piece whose ends move uniformly during a step, for bounds. It
/// consists of the middle and half edge at the middle of the step, the motion of the
/// middle, and the additional motion of the ends.
struct PieceMotion {
  PieceMotion() = default;
  /// Takes the two ends at the start and at the end of the step, m.
  PieceMotion(const Vec& from0, const Vec& to0, const Vec& from1, const Vec& to1);
  Vec middle, half, moved;  // m
  double turned = 0;        // m
};

/// Computes a lower bound (m) of the distance of the two pieces of each pair during the
/// step. The bound is the distance at half of the step less the relative motion until its
/// ends. NaN if a piece is not finite. By lanes, about 10 ns per pair.
void least_approaches(std::span<const PieceMotion> motion,
                      std::span<BoxPairs::Pair> pairs);

}  // namespace tress::models
