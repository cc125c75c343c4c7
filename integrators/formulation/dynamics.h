#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "contract/forms/bordered_form.h"
#include "contract/forms/constraint_form.h"
#include "contract/forms/explicit_form.h"
#include "contract/forms/sparse_form.h"
#include "contract/integrator.h"
#include "linear/bordered.h"
#include "linear/kkt.h"

namespace tress::integrators {

/// Converts a count to the type of sizes.
inline std::size_t size(int n) { return static_cast<std::size_t>(n); }

/// A system together with the form its constraints take, as one set of equations in the
/// accelerations a (n) and multipliers lambda (m):
///
///     r = M a - f - G^T lambda = 0
///     c = 0, where c is, by formulation,
///         g'' + beta g' + alpha g   (Baumgarte; acceleration and projection with
///                                    alpha = beta = 0)
///         g                         (index 3)
///
/// Unconstrained systems, and every system under `correction`, pass through to
/// System::linearize and solve. Constrained ones are solved by the KKT matrix of
/// linear/kkt.h, or by linear/bordered.h if the system has a BorderedForm. No call
/// allocates after the first.
class Dynamics {
 public:
  /// Takes formulation, gains and linear solver from the options; the system must
  /// outlive it.
  Dynamics(System& system, const Options& options);

  /// Returns the number of coordinates.
  int n() const { return layout_.coordinates; }
  /// Returns the number of constraints.
  int m() const { return layout_.constraints; }
  /// Returns the system.
  System& system() { return system_; }
  /// Returns the constraints; null if the system has none.
  ConstraintForm* constraints() { return constraints_; }

  /// Counts residuals, linearizations and solves; integrators add the rest.
  Stats stats;

  /// r (n) and c (m) at any state; neither has to vanish.
  Status residual(double t, In q, In v, In a, In lambda, Out r, Out c) noexcept;

  /// Prepares solve() for x = dr/d(...) under w, with w.acc = 1: q moves by w.pos x, v by
  /// w.vel x, a by x. Omits the derivative of the bias with respect to q only.
  Status linearize(double t, In q, In v, In a, In lambda, Weights w) noexcept;

  /// (r, c) -> (x, y): S x - G^T y = r and (dc) x = c, as linearize() left the matrix.
  Status solve(InOut r, InOut c) noexcept;

  /// State at which directional() is called: a new one (`fresh`), or that of its last
  /// call
  /// (`kept`).
  enum class Base { fresh, kept };

  /// Computes the derivative of (r, c) along (dq, dv) at fixed a and lambda by a forward
  /// difference. The cost is one residual, or two with a fresh base; zero directions cost
  /// nothing. The relative error is about 1e-8, enough for the right-hand side of a
  /// Newton correction.
  Status directional(double t, In q, In v, In a, In lambda, In dq, In dv, Out dr, Out dc,
                     Base base = Base::fresh) noexcept;

  /// a and lambda that satisfy r = 0 and g'' = -alpha g - beta g' at (t, q, v); leaves
  /// the mass matrix with the constraints of this state factored for solve(). A singular
  /// mass matrix determines no acceleration; a is then that of a short linearly implicit
  /// step, after which massless coordinates are nearly in equilibrium.
  Status accelerate(double t, In q, In v, Out a, Out lambda) noexcept;

  /// Source of non-finite numbers as reported by System::not_finite: at the state at
  /// which the system failed since forget() (the first finite one of several), else at
  /// the given state. Empty when the model finds nothing there.
  std::string culprit(double t, In q, In v);
  /// To be called after a successful step; the only cost while all is finite.
  void forget() {
    lost_ = Lost::nowhere;
    reached = driven = 0;
  }
  /// The part of the step that failed at which its solution turned back; 0: not known.
  double reached = 0;
  /// Speed (m/s) at which exact friction did work on a slide, where the best solution of
  /// the failed step violated the law of friction. 0: not the reason of the failure.
  double driven = 0;

  /// To be called before a run: resets the counts and all memory of the previous run.
  void begin() {
    gradient_t_ = std::numeric_limits<double>::quiet_NaN();
    stats = Stats{.solver = stats.solver};
    ++matrices_;
    forget();
  }
  /// Identifies the matrix that solve() uses: changes with every linearize(),
  /// accelerate(), begin().
  long matrix() const { return matrices_; }
  /// Somebody else has factored the system's.
  void lose_matrix() { ++matrices_; }

  /// Typical sizes of the coordinates and velocities (System::scale), and of g.
  In q_typ() const { return q_typ_; }
  /// Returns the typical sizes of the velocities.
  In v_typ() const { return v_typ_; }
  /// Returns the typical sizes of the constraints, m.
  In g_typ() const { return g_typ_; }

 private:
  enum class Lost { nowhere, at_infinity, at_finite_state };

  Status noted(Status s, double t, In q, In v) noexcept {
    if (s != Status::ok) keep_lost(t, q, v);
    return s;
  }
  void keep_lost(double t, In q, In v) noexcept;
  Status constraint_row(double t, In q, In v, In a, Out c) noexcept;
  Status assemble(double t, In q, In v, In a, In lambda, Weights w) noexcept;
  Status find_gradient(double t, In q) noexcept;
  Status constraint_tangent(double t, In q, In v, In a, Weights w) noexcept;

  System& system_;
  Layout layout_;
  BorderedForm* bordered_form_;
  SparseForm* sparse_;  // null: not used
  ConstraintForm* constraints_;
  ExplicitForm* explicit_;
  bool position_level_;
  bool base_ready_ = false;
  double alpha_ = 0, beta_ = 0;
  double start_step_ = 0;  // s, step of accelerate() for singular mass
  Weights weights_;
  long matrices_ = 0;
  std::optional<Kkt> kkt_;
  std::optional<Bordered> bordered_;
  // State of gt_, whose rows are full; no memory of a system with a BorderedForm changes
  // it at the same q. NaN: none.
  double gradient_t_ = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> gradient_q_;
  std::vector<double> q_typ_, v_typ_, g_typ_;
  std::vector<double> s_, gt_, ht_, rate_gt_;                         // matrix values
  std::vector<double> zero_n_, zero_m_, q_shift_, v_shift_, r_base_;  // scratch
  std::vector<double> g_, g_dot_, c_base_;
  Lost lost_ = Lost::nowhere;  // at the state below
  double lost_t_ = 0;
  std::vector<double> lost_q_, lost_v_;
};

/// Largest |x_i| / typ_i; infinity when any entry is not finite.
double scaled_norm(In x, In typ) noexcept;

}  // namespace tress::integrators
