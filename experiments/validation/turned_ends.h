#pragma once

#include <vector>

#include "experiments/validation/test.h"

namespace tress::experiments::validation {

/// Tests of a thread between a clamp and a support that turns and pushes it, without
/// springs (TurnedRod). They measure the twisting moment at which the thread buckles and
/// the shortening at which it jumps into a loop. The third one measures the angle of the
/// plies that wind up after the jump (`plectoneme`).
std::vector<ValidationTest> turned_end_tests();

/// Returns the twisting moment M (in EI/L) at which a straight isotropic rod between
/// clamps buckles under a tension T (in EI/L^2; negative: a thrust). The clamps may
/// approach each other. With w = y + iz, the linearised equation [Love 1927, section 272]
/// is
///
///     w'''' - i M w''' - T w'' = 0,   w = w' = 0 at both ends,
///
/// and has a solution where, with D^2 = M^2 - 4 T,
///
///     D (cos(D/2) - cos(M/2)) = T sin(D/2).
///
/// T = 0: tan(M/2) = M/2, M = 8.987 [Greenhill 1883]; M = 0: T = -4 pi^2 [Euler 1744]; T
/// large: M = 2 sqrt(T). Throws InputError unless T > -39.
double twist_that_buckles(double tension);

/// Jump of a long rod into self-contact, when ends that have turned against each other
/// come closer [Coyne 1990; Neukirch, van der Heijden & Thompson 2002]. The rod is
/// infinite and its loading rigid. LocalisedHelix has the shapes. With R the
/// rotation, a the largest tilt from the axis and c = GJ/EI, their shortening is
///
///     d/L = 4 sin a / (c (R - 2 a)),
///
/// which is largest at the jump, where tan a = -(R - 2 a)/2.
struct LoopJump {
  double tilt;        // rad
  double shortening;  // d/L
};
/// `rotation` in rad, of 2 pi or more.
LoopJump loop_jump(double rotation, double twist_over_bend);

}  // namespace tress::experiments::validation
