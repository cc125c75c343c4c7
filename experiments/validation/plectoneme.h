#pragma once

#include <array>
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
/// [form of Clauvelin, Audoly & Neukirch 2009; derived again by minimising the energy].
/// T is the load on the handle, R and a are those of the plies.
///
/// The handle is the last 8 % of the thread, thick, straight and then bent by a right
/// angle, and held at three points. Held at two it would turn about the line through them
/// and release all the twist.
std::vector<ValidationTest> plectoneme_tests();

/// plectoneme_exact: the same with exact contact of the plies and Coulomb's friction
/// between them.
///
/// A clamp that twists the thread on and back again gets back what it gave but for
/// friction: the plies wind on each other as they grow. Friction acts on axes
/// (StrandFriction), so that plies which turn about their common axis rub all along, as
/// threads do that cannot roll on each other.
std::vector<ValidationTest> plectoneme_exact_tests();

/// The thread of the experiment and what holds its handle.
struct HeldThread {
  struct Hand {
    int node;
    Vec place;  // m, from where it pulls
  };
  static constexpr double stiffness = 1;  // of each hand, N/m: yields by 0.4 mm
  /// R, the contact radius (m): it keeps the plies apart by more than the thread's
  /// thickness, so that fewer segments follow its turns.
  static constexpr double ply_radius = 4e-3;

  Strand strand;
  std::array<Hand, 3> hands;
  double settled;  // s, when its plies have come to rest

  /// Returns the pull of a hand, N.
  Vec pull(const Hand& hand, std::span<const double> x) const;
  double tension(std::span<const double> x) const;  // N, along the clamp
  /// N m, about the clamp's axis: at rest the clamp has the same.
  double moment(std::span<const double> x) const;
  /// Angle of its plies over that of equilibrium. Throws std::runtime_error without any.
  double angle_over_equilibrium(std::span<const double> x) const;
};
/// Throws InputError with too few elements.
HeldThread held_thread(const ModelVariant& variant, int elements, double turns);

/// Work (J) of the clamp that twists the plectoneme of 12 turns by four more in 2 s, and
/// the work returned on the same way back. Steps are of dt (s).
struct TwistWork {
  double given, returned;
};
TwistWork twist_on_and_back(const ModelVariant& variant, int elements, double friction,
                            double dt, const Deadline& deadline);

/// The angle a (rad) of the equation above, for T R^2/EI > 0.
double ply_angle(double tension);

/// Mean radius of the two plies of a curve and their mean angle from the axis. The curve
/// goes through `x` (3 per point, `apart` m from point to point). The plies are where the
/// curve comes within `reach` (m) of itself at more than `separation` (m) along it. The
/// three pairs at either end are excluded. Without plies, pairs = 0.
struct Ply {
  int pairs = 0;
  double radius = 0, angle = 0;  // m, rad
};
Ply ply(std::span<const double> x, double apart, double separation, double reach);

}  // namespace tress::experiments::validation
