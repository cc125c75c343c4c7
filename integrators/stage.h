#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "integrators/control/effort.h"
#include "integrators/formulation/dynamics.h"
#include "integrators/newton_rules.h"
#include "integrators/secant_updates.h"

namespace tress::integrators {

/// The nonlinear equations of one implicit stage, shared by every implicit fixed-step
/// method: find a (n) and lambda (m) with
///     r(t, q, v, a) = G^T lambda,  c = 0,   q = q_bar + w.pos a,  v = v_bar + w.vel a
/// by Newton's method, with old matrices as far as `refresh` allows, then without. If
/// that does not converge (long steps of shaken strands), steps are damped by the natural
/// monotonicity test [Deuflhard 2011, Newton Methods for Nonlinear Problems,
/// section 3.3], from the guess, from zero acceleration and from standstill. If that
/// fails too, a shortened step is solved and lengthened gradually [section 5.1]: first
/// with the drift of the whole step, for soft strands that fall far in one step; then
/// with the drift of the shortened step, for strands that turn fast, which the drift of
/// the whole step carries out of reach of any guess. Where that gets stuck, the solution
/// is followed by pseudo-arclength continuation [Keller 1977, in Applications of
/// Bifurcation Theory, 359], which passes the places where it turns back: it either comes
/// to the whole step, or Dynamics learns at which part of the step it turned back
/// (`reached`), beyond which no solution continues the motion.
///
/// With a discontinuous force, such as that of a contact whose location switches, there
/// may be no solution: the step from either side of the jump leads to the other, and
/// Newton's iteration alternates between them. The solution is then taken in the sense of
/// [Filippov 1988]: the state on the jump at which a mean of the forces of both sides
/// solves the equations. There a mean of Newton's corrections from both sides vanishes.
///
/// Systems with a StressForm have the stresses of their matrices from the last solution
/// (leave()), then from Newton's corrections: an edge that turns within an iteration is
/// not stretched by that.
///
/// Options: newton_tolerance bounds the last correction of q and v over System::scale,
/// newton_iterations, refresh. The iteration also ends where the error that its rate lets
/// expect is below Ending::remaining times newton_tolerance, and where corrections of the
/// size of rounding errors stop shrinking. With exact contact, whose forces may change
/// their side in the last iteration, such an error is measured before it is believed, by
/// a correction with the same matrix.
class Stage {
 public:
  struct Ending {
    double remaining = NewtonRules::margin;
    /// Stages learn from those before that had the same matrix, which is improved
    /// (SecantUpdates). For smooth equations without multipliers. Only the matrix is
    /// taken over: a first correction is never the last one on the strength of the rate
    /// of the stage before [as Hairer, Wanner 1996, Solving ODEs II, IV.8, allow]. That
    /// rate is one direction's, and the errors that it did not see made steps shorter and
    /// added up over them: 40 tolerances at 1e-5 where 7 are left without
    /// (tests/control/test_tolerance_family.cpp).
    bool learns = false;
    /// A correction of this size (System::scale), if it is the first one or has a new
    /// matrix, leaves the matrix out of date, whatever its rate.
    double turned = std::numeric_limits<double>::infinity();
  };
  Stage(Dynamics& dynamics, const Options& options) : Stage(dynamics, options, {}) {}
  Stage(Dynamics& dynamics, const Options& options, Ending ending);

  /// The matrix under Refresh::every_step: of this stage's own, or shared with the stage
  /// solved before, of the same step. Either is rebuilt where it converges slowly, and
  /// then serves the next stages no more: they have their own.
  enum class Matrix { own, shared };

  /// a, lambda: guess in, solution out. `retry` when the iteration does not converge.
  /// With exact contact (ContactForm): repeats solution and improvement of its
  /// multipliers until the law holds within Options::contact_tolerance; where a later
  /// solution fails, or after Options::contact_iterations, the one before stands, and
  /// stats tell by how much the law is violated. `retry` where friction would do work on
  /// a slide: ContactForm::drive() above that tolerance.
  Status solve(double t, In q_bar, In v_bar, Weights w, InOut a, InOut lambda,
               Matrix matrix = Matrix::own, Effort effort = Effort::whole) noexcept;

  /// Where solve() goes on from along the bodies that points may touch (ContactForm): x0
  /// in X = x0 + tau U. Empty without exact contact.
  InOut place_bar() { return place_bar_; }
  /// X, or U, at a state, in vectors of that size.
  void places(double t, In q, In v, Out x) noexcept {
    if (contacts_ != nullptr) contacts_->places(t, q, v, x);
  }
  void slides(double t, In q, In v, Out u) noexcept {
    if (contacts_ != nullptr) contacts_->slides(t, q, v, u);
  }

  /// The state from which the next solution goes on, to be told of every step: its
  /// stresses are near those of the solution, where those of a guess need not be.
  void leave(double t, In q) noexcept;

  /// Exactly one Newton step from the guess, converged or not (semi-implicit methods),
  /// with the matrix at acceleration a_matrix.
  Status single_step(double t, In q_bar, In v_bar, Weights w, In a_matrix, InOut a,
                     InOut lambda) noexcept;

  In q() const { return q_; }  // of the last call
  In v() const { return v_; }

 private:
  /// The force-free motion assumed for a shortened step.
  enum class Drift { whole, own };
  /// A point near a jump, and Newton's correction there.
  struct Side {
    Side(std::size_t n, std::size_t m) : a(n), lambda(m), a_step(n), lambda_step(m) {}
    std::vector<double> a, lambda, a_step, lambda_step;
    double size = 0;  // of a_step
  };

  /// The first solution, with multipliers of contact as they are at the start, and a
  /// penalty of its own for every attempt.
  Status first_contact(double t, In q_bar, In v_bar, Weights w, InOut a, InOut lambda,
                       Matrix matrix, Effort effort) noexcept;
  /// Later ones.
  Status next_contact(double t, In q_bar, In v_bar, Weights w, InOut a,
                      InOut lambda) noexcept;
  /// The state and the forces of rigid contacts at once: each iteration solves the
  /// equations and the laws of contact, linear about the last state [Josephy 1979], and
  /// is damped as those of damped() are. `touched`: something may have been in contact.
  Status with_forces(double t, In q_bar, In v_bar, Weights w, InOut a, InOut lambda,
                     bool& touched) noexcept;
  Status iterate_with_forces(double t, In q_bar, In v_bar, Weights w, InOut a,
                             InOut lambda, bool& touched) noexcept;
  /// How the contacts' velocities respond to forces, by the matrix of now.
  Status find_compliance(double t, Weights w, In a, In lambda,
                         std::size_t count) noexcept;
  /// From q_, v_ and the forces of now to those with which the step obeys the laws, up
  /// to `violation` (m/s).
  Status balanced_step(double t, Weights w, In a, In lambda, Out a_step, Out lambda_step,
                       double& size, double& violation) noexcept;
  /// Takes the step a_step_, lambda_step_ and that of the forces, or the largest halving
  /// of it after which the next one, by the same matrix, is smaller.
  Status halve_with_forces(double t, In q_bar, In v_bar, Weights w, double size, InOut a,
                           InOut lambda) noexcept;
  void go(In q_bar, In v_bar, Weights w, double part, InOut a, InOut lambda) noexcept;
  /// The equations with multipliers of contact as they are.
  Status solve_smooth(double t, In q_bar, In v_bar, Weights w, InOut a, InOut lambda,
                      Matrix matrix, Effort effort) noexcept;
  Status by_newton(double t, In q_bar, In v_bar, Weights w, InOut a, InOut lambda,
                   Matrix matrix) noexcept;
  /// After by_newton() has failed.
  Status by_all_means(double t, In q_bar, In v_bar, Weights w, InOut a,
                      InOut lambda) noexcept;
  void place(In q_bar, In v_bar, Weights w, In a) noexcept;
  double size_of(In correction, Weights w) const noexcept;
  void take_stresses(double t, bool first) noexcept;
  Status newton(double t, In q_bar, In v_bar, Weights w, Refresh refresh, Matrix matrix,
                InOut a, InOut lambda) noexcept;
  /// Newton's step from q_, v_, the state that belongs to `a`, and its size.
  Status newton_step(double t, Weights w, In a, In lambda, Out a_step, Out lambda_step,
                     double& size) noexcept;
  Status damped(double t, In q_bar, In v_bar, Weights w, InOut a, InOut lambda) noexcept;
  Status lengthened(double t, In q_bar, In v_bar, Weights w, Drift drift, InOut a,
                    InOut lambda) noexcept;
  /// From a solution of `part` of the step, with its own drift.
  Status followed(double t, In q_bar, In v_bar, Weights w, double part, InOut a,
                  InOut lambda) noexcept;
  /// A point of the path of solutions, and its direction there.
  struct OnPath {
    OnPath(std::size_t n, std::size_t m) : a(n), lambda(m), a_along(n), lambda_along(m) {}
    std::vector<double> a, lambda, a_along, lambda_along;
    double part = 0, part_along = 0;
  };
  Status direction(double t, In q_bar, In v_bar, Weights w, OnPath& at) noexcept;
  Status correct_onto(double t, In q_bar, In v_bar, Weights w, const OnPath& from,
                      double length, OnPath& to) noexcept;
  Status equations(double t, In q_bar, In v_bar, Weights w, const OnPath& at, double part,
                   Out r, Out c) noexcept;
  Status matrix_at(double t, In q_bar, In v_bar, Weights w, const OnPath& at) noexcept;
  double along(Weights w, In a, double part, In a_other,
               double part_other) const noexcept;
  /// Starts where newton() ended; `retry` unless its iterates alternated there.
  Status on_jump(double t, In q_bar, In v_bar, Weights w, InOut a, InOut lambda) noexcept;
  Status close_in(double t, In q_bar, In v_bar, Weights w) noexcept;
  Status correction(double t, In q_bar, In v_bar, Weights w, Side& side) noexcept;
  double scaled_dot(In x, In y) const noexcept;
  double apart(const Side& x, const Side& y) const noexcept;
  Status halve_until_smaller(double t, In q_bar, In v_bar, Weights w, double size,
                             InOut a, InOut lambda) noexcept;
  Status correct(double t, In q_bar, In v_bar, Weights w, bool linearize, InOut a,
                 InOut lambda, double& correction) noexcept;

  Dynamics& dynamics_;
  ContactForm* contacts_;  // null: none
  StressForm* stresses_;   // null: none
  double contact_tolerance_;
  int contact_iterations_;
  NewtonRules rules_;
  double turned_;
  bool foresees_;  // with contacts, unless Newton's tolerance has its margin already
  int iterations_;
  Refresh refresh_;
  Weights factored_;  // of the matrix that newton() used last
  double rate_ = 0;   // of newton(): its last correction over the one before
  std::optional<SecantUpdates> updates_;  // of that matrix
  // Of newton() with matrices of its own, since the start of solve(): a correction over
  // the square of the one before, 0: unknown. It tells the next one before contacts are
  // solved again.
  double squared_ = 0;
  bool shares_ = true;  // the last matrix of this step served all stages so far
  long matrix_ = -1;    // its Dynamics::matrix(); other callers may have factored since
  double t_left_ = 0;
  bool left_ = false;                         // at t_left_ and q_left_
  std::vector<double> q_left_, q_corrected_;  // q_ before the last correction
  std::vector<double> q_, v_, r_, c_;
  std::vector<double> a_guess_, lambda_guess_;
  std::vector<double> a_kept_, lambda_kept_, a_step_, lambda_step_;  // of damped steps
  std::vector<double> a_held_, lambda_held_, place_bar_;             // of contacts
  // Forces of contacts and velocities that they cause, and the matrix between both.
  std::vector<double> force_, force_kept_, force_step_, velocity_, change_, compliance_;
  std::vector<double> r_free_, q_next_, v_next_;
  std::vector<double> q_start_, a_part_, lambda_part_, a_before_;  // of short ones
  Side here_, there_, middle_;                                     // of a jump
  OnPath path_, next_;
};

}  // namespace tress::integrators
