#pragma once

#include <limits>
#include <optional>

#include "contract/integrator.h"
#include "integrators/stage/secant_updates.h"
#include "integrators/stage/stage_equations.h"
#include "integrators/stage/stress_origin.h"

namespace tress::integrators {

/// Convergence criteria of Newton's method, and reuse of its matrix.
struct NewtonEnding {
  /// Expected remaining error over newton_tolerance at which the iteration ends.
  double remaining = NewtonRules::margin;
  /// Reuses the matrix of earlier stages, improved by SecantUpdates, where it is the
  /// same. For smooth equations without multipliers. Only the matrix is reused: the rate
  /// of the stage before never makes a first correction the last one [as Hairer, Wanner
  /// 1996, Solving ODEs II, IV.8, allow]. That rate belongs to one direction. The errors
  /// that it missed shortened the steps and accumulated: 40 tolerances at 1e-5, against 7
  /// without (tests/control/test_tolerance_family.cpp).
  bool learns = false;
  /// A correction of this size (System::scale), if it is the first one or has a new
  /// matrix, leaves the matrix out of date, whatever its rate.
  double turned = std::numeric_limits<double>::infinity();
};

/// Newton's method with whole corrections: the first way to solve any stage, and enough
/// for most. It uses old matrices as far as `refresh` allows, then none, then none with
/// the stresses of other states (StressOrigin).
///
/// Cost: a residual and a solve for each correction, at most newton_iterations of them in
/// each of the three attempts, and a matrix where the last one converges slowly.
///
/// newton_tolerance bounds the last correction of q and v over System::scale. The
/// iteration also ends where the error that its rate lets expect is below
/// NewtonEnding::remaining times newton_tolerance, and where corrections of the size of
/// rounding errors stop shrinking. With exact contact, whose forces may change their side
/// in the last iteration, such an error is measured before it is believed, by a
/// correction with the same matrix.
class Newton {
 public:
  /// The matrix under Refresh::every_step: of this stage's own, or shared with the stage
  /// solved before, of the same step. Either is rebuilt where it converges slowly, and
  /// then serves the next stages no more: they have their own.
  enum class Matrix { own, shared };

  /// `contacts`: the equations have exact contact.
  Newton(StageEquations& equations, StressOrigin& stresses, Refresh refresh,
         const NewtonEnding& ending, bool contacts);

  /// Solves the equations from a guess; x: the solution, or the last iterate with
  /// `retry`.
  Status solve(const Unknowns& guess, Matrix matrix, Unknowns& x) noexcept;
  /// One correction from x by the matrix at acceleration a_matrix.
  Status single_step(In a_matrix, Unknowns& x) noexcept;
  /// The last correction over the one before.
  double rate() const { return rate_; }
  /// The next solution is another one's, not an improvement of the last.
  void begin() noexcept { squared_ = 0; }

 private:
  Status iterate(Refresh refresh, Matrix matrix, bool stresses, Unknowns& x) noexcept;
  Status correct(bool linearize, Unknowns& x, double& correction) noexcept;

  StageEquations& equations_;
  StressOrigin& stresses_;
  Refresh refresh_;
  double turned_;
  bool contacts_;
  bool foresees_;     // with contacts, unless Newton's tolerance has its margin already
  Weights factored_;  // of the last matrix
  double rate_ = 0;
  std::optional<SecantUpdates> updates_;  // of that matrix
  // With matrices of its own, since begin(): a correction over the square of the one
  // before, 0: unknown. It tells the next one before contacts are solved again.
  double squared_ = 0;
  bool shares_ = true;  // the last matrix of this step served all stages so far
  long matrix_ = -1;    // its Dynamics::matrix(); other callers may have factored since
  Unknowns step_;
};

}  // namespace tress::integrators
