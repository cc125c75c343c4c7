#pragma once

#include <array>

#include "models/effects/effect.h"
#include "models/motion/root_motion.h"

namespace tress::simulation {

using models::Effect;
using models::Points;
using models::RootPose;

/// Energy of strands seen from the frame of their clamp, and what changes it.
struct EnergyMeasure {
  double kinetic = 0, potential = 0;  // J, in the moving frame
  double power = 0;                   // W, into it
  /// J, of the masses at the velocities that the frame and bodies in contact can give.
  double driven = 0;
  double work = 0;  // J, into it since the last measure, next to power

  /// Transforms points under a load (3 numbers each, N) from the world's frame to the
  /// clamp's. Writes the relative velocities to `u`.
  void move_with(const RootPose& root, const Points& p, In load, Out u);
  /// Adds what a moving body can give to a strand of this mass (kg), if it is in contact
  /// with a point of it or nearer than a segment (m). Points are at x (3 numbers each).
  void touch(const Effect& effect, double t, In x, double segment, double mass);
};

/// Energy of a motion above that of its start and the work of its loads. Physics allows
/// none of it, but the error of coarse steps does.
struct Excess {
  double gained = 0;  // largest so far, J
  double slack = 0;   // largest that a guard lets pass, J

  /// Returns the part of the slack that is used.
  double share() const { return slack > 0 ? gained / slack : 0; }
  /// Takes the one of two strands that uses more of its slack.
  void take(const Excess& other) {
    if (other.share() > share()) *this = other;
  }
};

/// Bound of the energy of a motion. In a frame that moves with the clamp, the clamp does
/// no work. A point of mass m has position x and velocity v. The frame has velocity w = V
/// + omega x r there, and u = v - w. The loads of all effects are f. Their non-potential
/// part has the power P in the world's frame, and the rest has the potential V_p. The
/// Coriolis term does no work. With a_w = A + alpha x r + omega x (omega x r),
///
///     E = sum m u^2/2 + V_p,   dE/dt <= P - sum (f.w + m a_w.u),
///
/// where internal friction only decreases E. The work W is the sum of the positive parts
/// of the right-hand side, taking the larger of the two ends of each interval. A motion
/// satisfies
///
///     E <= E(0) + slack + 1.1 W + largest D,   D = sum m w^2/2 + 2 m s^2,
///
/// where a tenth of W allows for the error of its sums over points and intervals. The
/// first part of D allows for sums over lumped masses; a root at rest has w = 0. The
/// second allows for the impulses of bodies, whose power is sampled: a body at the speed
/// s throws a strand of mass m to 2 s at most. Without the
/// tenth a weightless strand in wind breaks the bound by 1 % however short its steps: the
/// energy is the model's, the work is that on lumped masses.
///
/// Speed: E minus the lowest potential so far bounds the kinetic energy. If a tenth of
/// the strand has all of it and turns about its own start, its tip moves at sqrt(30)
/// times the root mean square speed.
class EnergyAccount {
 public:
  /// Allowance for the error of coarse but sound steps: a tenth of the start's kinetic
  /// and elastic energy (J), which counts as error, not gain.
  static double share(double kinetic, double elastic);

  /// Starts the account with the first measure; slack in J.
  void start(double t, const EnergyMeasure& begin, double slack);
  /// Adds the work of the interval since the last measure.
  void gather(double t, const EnergyMeasure& now);
  /// Goes on at t after a teleport: the change of the energy there is no gain.
  void shift(double t, const EnergyMeasure& before, const EnergyMeasure& now);
  double seen() const { return seen_; }  // s, when gathered last
  /// Returns the energy above that of the start, J.
  double gain(const EnergyMeasure& now) const;
  /// Returns the largest energy that no work explains since start().
  Excess excess() const { return {excess_, slack_ + driven_}; }
  /// Returns the bound of gain(), J.
  double allowed() const;
  /// Bound of the speed of a point (m/s) of a strand of so much mass (kg).
  double fastest(double mass) const;

  /// All data gathered since start(); another account that recalls them goes on there.
  static constexpr std::size_t remembered = 8;
  /// Numbers of an account.
  using Memory = std::array<double, remembered>;
  /// Returns what start() and gather() have found.
  Memory memory() const;
  /// Restores what memory() returned.
  void recall(In memory);

 private:
  double energy_ = 0, slack_ = 0;  // at the start
  double seen_ = 0, power_ = 0;    // when gathered last
  double work_ = 0, driven_ = 0, lowest_ = 0, excess_ = 0;
};

}  // namespace tress::simulation
