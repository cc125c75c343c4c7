#pragma once

#include <span>
#include <vector>

#include "experiments/validation/test.h"

namespace tress::experiments::validation {

/// The plectoneme experiment: a thread is twisted by 12 turns at its clamp, then let in
/// by 0.3 L against a handle that cannot turn. It snaps into a loop that winds itself up,
/// two plies that touch (effect self_contact) on a cylinder of radius R at the angle a
/// from its axis. Under the tension T of what is still straight, energy is least where
///
///     T = EI/R^2 sin^4 a (1/2 + 1/cos 2a)
///
/// [form of Clauvelin, Audoly & Neukirch 2009; derived anew by minimising the energy].
/// T is what the handle has to bear, R and a are those of the plies.
///
/// The handle is the last 8 % of the thread, thick, straight and then bent by a right
/// angle, and held in three places. In two of them it would turn about the line through
/// them and let all the twist out.
std::vector<ValidationTest> plectoneme_tests();

/// The angle a (rad) of the equation above, of T R^2/EI > 0.
double ply_angle(double tension);

/// Mean radius and angle from its axis of the two plies that a curve through `x` (3 per
/// point, `apart` m from point to point) makes where it comes within `reach` (m) of
/// itself farther than `separation` (m) along it; without the three pairs at either end.
/// pairs = 0: there is none.
struct Ply {
  int pairs = 0;
  double radius = 0, angle = 0;  // m, rad
};
Ply ply(std::span<const double> x, double apart, double separation, double reach);

}  // namespace tress::experiments::validation
