#pragma once

#include <cstddef>
#include <vector>

#include "contract/basics.h"

namespace tress {

/// Laws of rigid contact, linear about a state, for methods that solve for the state and
/// the contact forces at once [Josephy 1979]. Contact velocities respond linearly to the
/// contact forces, which obey the laws exactly. Vectors have three entries per contact:
/// along the normal, and along two tangents.
class Complementarity {
 public:
  virtual ~Complementarity() = default;
  /// Takes the contacts that hold forces or overlap at one of two states, of which the
  /// first is the one that all below is linear about. Their forces are constants from
  /// here to let_go(), those that they held at first. Their number.
  virtual std::size_t take(double t, In q, In v, In q_next, In v_next) noexcept = 0;
  /// Writes the contact forces, N.
  virtual void forces(Out f) const noexcept = 0;
  /// Sets the contact forces, N. Normal components must be >= 0.
  virtual void set_forces(In f) noexcept = 0;
  /// Computes the quantities that the laws restrict, m/s. Normal entry: the gap over the
  /// time that closes it, or the excess over the rebound speed. Tangential entries: the
  /// velocity along the surface.
  virtual void velocities(double t, In q, In v, Out u) noexcept = 0;
  /// Computes the change of the contact velocities du (m/s) due to a change dv of the
  /// rates.
  virtual void responses(In dv, Out du) noexcept = 0;
  /// Forces that obey the laws where contacts have the velocities u + W (f - f_given); W
  /// by columns. By how much they violate them, m/s.
  virtual double balance(In w, In u, double tolerance, InOut f) noexcept = 0;
  /// Penalties act again; unless the forces were found, multipliers are those of before.
  virtual void let_go(bool found) noexcept = 0;
};

/// Contact forces that obey the laws of Signorini and Coulomb without regularisation. A
/// multiplier, a penalty and the state determine each force, so the equations remain
/// functions of the state. Solving the equations and improving the multipliers alternate
/// until the laws are satisfied (augmented Lagrangian). The laws refer to the state at
/// which the equations are solved: methods use them at ends of steps or stages.
///
/// Friction acts against the slide U = X', where X are the positions of points in the
/// frames of the bodies. A method integrates X as it integrates q: its stage has X = x0 +
/// tau U with its own x0. A sticking point stays in place however the body turns.
class ContactForm {
 public:
  virtual ~ContactForm() = default;
  /// Prepares the equations of a state that lies `tau` (s) ahead: q = q0 + tau v and X =
  /// x0 + tau U. The motion continues from the state (q0, v0).
  virtual void begin(double t, double tau, In q0, In v0, In x0) noexcept = 0;
  /// After they are solved, at the solution: takes the forces found as the multipliers.
  /// The largest speed (m/s) by which the solution violates the law.
  virtual double improve(double t, In q, In v) noexcept = 0;
  /// The largest T.U/(mu N) of the forces and slides that improve() took, m/s: friction
  /// does work on a slide where it is positive.
  virtual double drive() const noexcept = 0;
  /// Before they are solved again: multipliers farther along the way that improvements
  /// have taken.
  virtual void extrapolate() noexcept = 0;
  /// Largest speed (m/s) at which points whose rigid contact is closed approach their
  /// surface: where it is not 0 velocities jump, and forces are an impulse over tau.
  virtual double approach(double t, In q, In v) noexcept = 0;
  /// After an impact: the contacts stay closed, without the forces of the impulse.
  virtual void release() noexcept = 0;
  /// Whether points may rebound: v0 must then be the velocity before the impact.
  virtual bool rebounds() const = 0;
  /// Null: some contact is not rigid, or the laws are not known in this form.
  virtual Complementarity* complementarity() { return nullptr; }
  /// The multipliers, of fixed number; 0 at first.
  virtual std::vector<double> multipliers() const = 0;
  /// Sets the multipliers to those of an earlier call of multipliers().
  virtual void set_multipliers(In values) = 0;
  /// Returns the number of coordinates X; fixed for life.
  virtual std::size_t tracked() const = 0;
  /// Computes the coordinates X, m.
  virtual void places(double t, In q, In v, Out x) noexcept = 0;
  /// U of the last solution where it has closed contacts, that of v elsewhere; m/s.
  virtual void slides(double t, In q, In v, Out u) noexcept = 0;
};

}  // namespace tress
