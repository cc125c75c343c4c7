#pragma once

#include <array>

#include "models/strand/element_points.h"

namespace tress::models {

/// Frames along an element that winds by more than 4 rad: those of up to
/// most_points_of_element points, then that of the tip, nine numbers each (store9()).
struct LongTurning {
  std::array<double, 9 * (most_points_of_element + 1)>
      frames;  // of the points and the tip
};

/// Computes the frames of one strand by TurningOf<double>. `ab`: a and b of turning.h;
/// `y`: places of the points in [-1, 1] (points). A function that kernels do not inline:
/// its bits do not depend on theirs. Its arguments have no packs, which some instruction
/// sets pass in other ways (math/instructions.h).
void turn_far(const double (&ab)[6], int points, const double* y, LongTurning& to);

}  // namespace tress::models
