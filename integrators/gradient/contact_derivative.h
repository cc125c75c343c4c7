#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "integrators/formulation/dynamics.h"
#include "integrators/gradient/closed_contacts.h"
#include "integrators/gradient/varied_system.h"
#include "linear/least_norm.h"

namespace tress::integrators {

/// Derivatives of the forces of exact rigid contact at the solution of a stage. Closed
/// contacts stay in their cases. With the normal entry w of
/// Complementarity::velocities(), the slide U and the force (N, T), their laws are then
/// equations for the forces:
///
///     dw = 0                                         all
///     dU = 0                                         sticking
///     d|T| = d(mu N),  |U| s.dT + mu N s.dU = 0      sliding, s perpendicular to T
///
/// They are solved together with the variational equations, in which forces of unit size
/// respond through S^-1. A strand may have more contacts than unknowns: its forces are
/// then those of least norm, and all that obey the laws give the same motion.
///
/// Cost of a stage: a residual, a solution and two evaluations of the laws for each
/// component of a closed contact, and a decomposition of that size.
class ContactDerivative {
 public:
  /// `dynamics`: of the system of the run, whose contacts have a Complementarity. All
  /// must outlive it.
  ContactDerivative(Dynamics& dynamics, std::span<const VariedSystem> varied);

  /// To be called before a run.
  void begin();
  /// The step in progress begins at this state, which must last until the next call.
  void start(const WatchedSystem::Motion& state) { from_ = &state; }
  /// Holds the forces of all systems constant, at those of a stage's solution, which must
  /// last until the next call. False: systems of changed parameters have other contacts.
  bool hold(const WatchedSystem::Motion& end);
  /// Message of the error then.
  static constexpr std::string_view other_contacts =
      "a small change of a parameter closes a contact or makes it rebound: give another "
      "step, or restitution = 0";

  /// Case of a point that is in contact.
  struct Case {
    std::size_t id;         // ClosedContact::id
    bool slides, rebounds;  // friction is at its bound; ClosedContact::rebounds
    /// Compares all.
    bool operator==(const Case&) const = default;
  };
  /// Returns the cases at the last solution.
  const std::vector<Case>& cases() const { return cases_; }
  /// Returns the number of equations of the laws.
  std::size_t rows() const { return rows_; }

  // The columns of the variational equations, one for each parameter.
  /// Returns the number of coordinates of ContactForm::places().
  std::size_t tracked() const { return tracked_; }
  /// Computes the derivative of ContactForm::places() where the step in progress begins,
  /// by parameter k and along dq.
  void places(std::size_t k, In dq, Out dx);
  /// Derivatives of the arguments of ContactForm::begin(), of all parameters.
  void begin_columns(In dq0, In dv0, In dx0);
  /// After S(w) was factored.
  Status factor(Weights w) noexcept;
  /// Writes the derivatives g (rows) of the laws by parameter k and along (dq, dv).
  void laws(std::size_t k, In dq, In dv, Out g);
  /// x = S^-1 r becomes the solution with forces that keep the laws, whose derivatives
  /// were g.
  void correct(In g, InOut x);

  /// Computes the derivatives of the normal entries of the laws by parameter k and along
  /// dq at a state of the coordinates, with the forces of hold().
  void normal_laws(std::size_t k, double t, In q, In dq, Out dw);
  /// Computes the rates of these entries along the motion (dt = 1, v).
  void normal_rates(double t, In q, In v, Out rate);
  /// Computes the acceleration without contact at a state.
  Status free_acceleration(double t, In q, In v, Out a);

 private:
  using Values = ClosedContacts::Values;
  /// Change of a stage's solution and of where it begins (empty: of nothing).
  struct Direction {
    In q, v, q0, v0, x0;
  };

  void combine(const Values& change, Out g) const;
  bool find_cases();
  double distance_along(const Direction& d) const;
  void along(const Direction& d, Out g);
  void hold_moved(double e, const Direction& d);
  void values_moved(double e, const Direction& d, Values& found);
  void add_parameter(std::size_t k, Out g);
  void normal_along(double t, In q, double dt, In dq, Out dw);

  Dynamics& dynamics_;
  std::span<const VariedSystem> varied_;
  std::size_t tracked_;
  ClosedContacts own_;
  std::vector<std::vector<ClosedContacts>> others_;  // of varied_
  const WatchedSystem::Motion *from_ = nullptr, *end_ = nullptr;
  std::vector<Case> cases_;
  std::size_t rows_ = 0;
  Values at_, plus_, minus_, change_;
  Weights w_;
  std::vector<double> responses_;  // S^-1 of forces, by rows
  LeastNorm forces_;
  std::vector<double> dq0_, dv0_, dx0_;  // of all columns
  std::vector<double> none_, q_, v_, q0_, v0_, x0_, x_, g_;
};

}  // namespace tress::integrators
