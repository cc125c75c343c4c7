#pragma once

#include <span>
#include <vector>

#include "experiments/validation/test.h"

namespace tress::experiments::validation {

/// The plectoneme experiment: a thread is twisted by 12 turns at its clamp, then fed in
/// by 0.3 L against a handle that cannot turn. It snaps into a loop that winds itself up,
/// two plies that touch (effect self_contact) on a cylinder of radius R at the angle a
/// from its axis. Under the tension T of the straight part, energy is least where
///
///     T = EI/R^2 sin^4 a (1/2 + 1/cos 2a)
///
/// [form of Clauvelin, Audoly & Neukirch 2009; derived anew by minimising the energy]. T
/// is the load on the handle, R and a are those of the plies.
///
/// The handle is the last 8 % of the thread, thick, straight and then bent by a right
/// angle, and held at three points. Held at two it would turn about the line through them
/// and release all the twist.
std::vector<ValidationTest> plectoneme_tests();

/// The angle a (rad) of the equation above, for T R^2/EI > 0.
double ply_angle(double tension);

/// Mean radius and angle from its axis of the two plies of a curve through `x` (3 per
/// point, `apart` m from point to point) where it comes within `reach` (m) of itself at
/// more than `separation` (m) along it; excludes the three pairs at either end. pairs =
/// 0: no plies.
struct Ply {
  int pairs = 0;
  double radius = 0, angle = 0;  // m, rad
};
Ply ply(std::span<const double> x, double apart, double separation, double reach);

}  // namespace tress::experiments::validation
