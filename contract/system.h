#pragma once

#include <limits>
#include <string>
#include <vector>

#include "contract/basics.h"

/// The contract between models (what moves) and integrators (how time advances).
///
/// A model is a mechanical system over coordinates q (n of them), q' = v, v' = a, with
/// optional position constraints g(t, q) = 0 (m of them) and multipliers lambda:
///
///     r(t, q, v, a) = M(t, q) a - f(t, q, v),      r - G^T lambda = 0,   G = dg/dq
///     S(w) = w.acc dr/da + w.vel dr/dv + w.pos dr/dq
///
/// Every implicit method is a choice of the three weights: backward Euler (1, h, h^2),
/// Newmark and generalized-alpha (1, gamma h, beta h^2), IDA (cj^2, cj, 1). So a model is
/// written once and every integrator drives it. Units are SI throughout.
namespace tress {

class SparseForm;
class ExplicitForm;
class ConstraintForm;
class ComplianceForm;
class StressForm;
class Energetics;
class MaterialPoints;
class History;
class ContactForm;

/// Sizes of a system.
struct Layout {
  int coordinates = 0;  // n
  int constraints = 0;  // m
};

/// Properties that an integrator may assume; they decide which integrators apply.
struct Traits {
  bool constant_mass = false;  // dM/dt = 0 and dM/dq = 0
  bool regular_mass = true;    // M is invertible at every state
};

/// One mechanical system. `residual` is pure; `linearize` prepares `solve`; nothing
/// allocates after the first call of each; only History::accept, ContactForm and
/// StressForm may change what it remembers.
class System {
 public:
  virtual ~System() = default;

  /// Returns the numbers of coordinates and of constraints, which never change.
  virtual Layout layout() const = 0;
  /// Returns the properties that integrators may assume.
  virtual Traits traits() const = 0;
  /// Writes the initial coordinates q (n) and velocities v (n), with g = 0 and
  /// G v + g_t = 0.
  virtual void initial_state(Out q, Out v) const = 0;
  /// Writes typical sizes of q and v (n each), all > 0; those of angles are 1 at most.
  virtual void scale(Out q_typ, Out v_typ) const = 0;
  /// Writes r(t, q, v, a) (n), without constraint forces. `retry` where it is not finite.
  virtual Status residual(double t, In q, In v, In a, Out r) noexcept = 0;
  /// Prepares solve() with S(w) at this state. `retry` where S cannot be factored.
  virtual Status linearize(double t, In q, In v, In a, Weights w) noexcept = 0;
  /// Solves S(w) x = b with the S of the last linearize(); b and x (n) may be the same.
  virtual Status solve(In b, Out x) noexcept = 0;

  /// Returns the first time after t at which the equations are not smooth in time: a
  /// prescribed motion stops, or a force is switched. Methods that rely on smoothness end
  /// a step there. Infinity: none.
  virtual double next_breakpoint(double /*t*/) const {
    return std::numeric_limits<double>::infinity();
  }

  /// Names the term of r(t, q, v, 0) that is not finite and its location: "quadratic_drag
  /// at point 7". Empty: all terms are finite, or the model does not report it.
  virtual std::string not_finite(double /*t*/, In /*q*/, In /*v*/) { return {}; }

  // Optional forms (contract/forms/), null when absent; queried once.
  /// Returns S(w) as a sparse matrix; required with constraints.
  virtual SparseForm* sparse_form() { return nullptr; }
  /// Returns the accelerations as an explicit function of the state.
  virtual ExplicitForm* explicit_form() { return nullptr; }
  /// Returns the constraints; required if Layout::constraints > 0.
  virtual ConstraintForm* constraint_form() { return nullptr; }
  /// Returns the forces as compliant constraints, for position-based methods.
  virtual ComplianceForm* compliance_form() { return nullptr; }
  /// Returns the choice of stresses in the matrix.
  virtual StressForm* stress_form() { return nullptr; }
  /// Returns energies and momentum.
  virtual Energetics* energetics() { return nullptr; }
  /// Returns the points of the body in space.
  virtual MaterialPoints* material_points() { return nullptr; }
  /// Returns the state that depends on past steps.
  virtual History* history() { return nullptr; }
  /// Returns contact forces that obey the exact laws.
  virtual ContactForm* contact_form() { return nullptr; }

  // All that is remembered: by the history, and the multipliers of contacts. Defined in
  // contract/forms/memory.cpp.
  /// Tells the history and the contacts that a step was accepted. True: the equations
  /// changed, so that multistep methods must restart.
  bool accept(double t, InOut q, InOut v);
  /// Discards all that is remembered.
  void reset();
  /// Returns all that is remembered, for recall().
  std::vector<double> memory();
  /// Restores what memory() returned.
  void recall(In memory);
};

}  // namespace tress
