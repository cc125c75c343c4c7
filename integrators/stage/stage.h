#pragma once

#include <optional>
#include <vector>

#include "contract/constants.h"
#include "contract/forms/contact_form.h"
#include "contract/forms/stage_watcher.h"
#include "integrators/stage/contact_forces.h"
#include "integrators/stage/continuation.h"
#include "integrators/stage/damped.h"
#include "integrators/stage/effort.h"
#include "integrators/stage/jump.h"
#include "integrators/stage/lengthened.h"
#include "integrators/stage/newton.h"

namespace tress::integrators {

/// Solves the nonlinear equations of one implicit stage: finds a (n) and lambda (m) with
///     r(t, q, v, a) = G^T lambda,  c = 0,   q = q_bar + w.pos a,  v = v_bar + w.vel a.
///
/// Each solution method is a class of its own. They are tried in this order until one
/// succeeds:
///
///     Newton         whole corrections
///     Jump           where Newton's iterates alternate between two states
///     Damped         from the guess, from zero acceleration and from standstill
///     Lengthened     a part of the step that grows, with the drift of the whole step,
///                    then with its own
///     Continuation   where the last of these gets stuck
///
/// With exact contact (ContactForm) the contact multipliers are constant while the
/// equations are solved. Improving the multipliers and solving the equations alternate
/// until the law is satisfied within Options::contact_tolerance (augmented Lagrangian).
/// ContactForces then follows Jump.
class Stage {
 public:
  /// Convergence criteria.
  using Ending = NewtonEnding;
  /// Reuse of the matrix.
  using Matrix = Newton::Matrix;

  /// Works on `dynamics`, which must outlive it, with the default criteria.
  Stage(Dynamics& dynamics, const Options& options) : Stage(dynamics, options, {}) {}
  /// Works on `dynamics`, which must outlive it.
  Stage(Dynamics& dynamics, const Options& options, Ending ending);
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  /// a, lambda: guess in, solution out. `retry` when nothing converges. Where a later
  /// solution with contact fails, or after Options::contact_iterations, the one before
  /// stands, and stats tell by how much the law is violated. `retry` where friction would
  /// do work on a slide: ContactForm::drive() above that tolerance.
  Status solve(double t, In q_bar, In v_bar, Weights w, InOut a, InOut lambda,
               Matrix matrix = Matrix::own, Effort effort = Effort::whole) noexcept;

  /// Exactly one Newton step from the guess, converged or not (linearly implicit
  /// methods), with the matrix at acceleration a_matrix.
  Status single_step(double t, In q_bar, In v_bar, Weights w, In a_matrix, InOut a,
                     InOut lambda) noexcept;

  /// Sets the state from which the next solution continues; call it at every step. The
  /// stresses of this state are near those of the solution, unlike those of a guess.
  void leave(double t, In q) noexcept { stresses_.leave(t, q); }

  /// Positions x0 in X = x0 + tau U along the bodies that points may touch (ContactForm),
  /// from which solve() continues. Empty without exact contact.
  InOut place_bar() { return place_bar_; }
  /// X, or U, at a state, in vectors of that size.
  void places(double t, In q, In v, Out x) noexcept {
    if (contacts_ != nullptr) contacts_->places(t, q, v, x);
  }
  /// Computes U at a state; leaves `u` where there is no exact contact.
  void slides(double t, In q, In v, Out u) noexcept {
    if (contacts_ != nullptr) contacts_->slides(t, q, v, u);
  }

  /// Whether rigid contacts that the last solution closed stop points: at (q, v) at t,
  /// the start of the step, some approach their surface faster than `gently` (m/s).
  /// Velocities jump there, and only a step that forgets those of before may follow.
  /// Methods with a fixed step take gentle_speed().
  bool stops(double t, In q, In v, double gently) noexcept {
    return contacts_ != nullptr && contacts_->approach(t, q, v) > gently;
  }

  /// Returns the speed (m/s) by which what rests falls in a step of h (s): no impact.
  static double gentle_speed(double h) { return h * earth_gravity; }

  In q() const { return equations_.q(); }  // of the last call
  /// Returns the rates of the last solution.
  In v() const { return equations_.v(); }

 private:
  void pose(double t, In q_bar, In v_bar, Weights w, In a, In lambda) noexcept;
  Status solve_with_contact(Matrix matrix, Effort effort) noexcept;
  Status first_contact(Matrix matrix, Effort effort) noexcept;
  Status next_contact() noexcept;
  Status by_newton(Matrix matrix) noexcept;
  Status by_all_means() noexcept;
  Status with_forces(bool& touched) noexcept;
  Status noted(Status s) noexcept;

  StageEquations equations_;
  StressOrigin stresses_;
  ContactForm* contacts_;  // null: none
  StageWatcher* watcher_;  // null: the system does not watch
  Newton newton_;
  Jump jump_;
  Damped damped_;
  Continuation continuation_;
  Lengthened lengthened_;
  Unknowns x_, guess_;  // guess_: of by_newton()

  // With contacts.
  double contact_tolerance_;
  int contact_iterations_;
  std::optional<ContactForces> forces_;
  Unknowns held_;  // the guess, or the last solution
  std::vector<double> q_start_, place_bar_;
};

}  // namespace tress::integrators
