#include <algorithm>
#include <utility>

#include "integrators/entry.h"
#include "integrators/error_indicator.h"
#include "integrators/fixed_step.h"
#include "integrators/stage/stage.h"
#include "linear/vector_ops.h"

namespace tress::integrators {
namespace {

/// One residual, one factorisation and one solve per step, like linearly_implicit_euler,
/// but order 2, with any tangent (a W-method). On linear systems with the exact Jacobian
/// it is as stable as implicit_midpoint. Otherwise the step must resolve the terms that
/// the tangent omits and the changes of the tangent, which the ErrorIndicator monitors.
/// [Steihaug, Wolfbrandt 1979, Math. Comp. 33, 521; Hairer, Wanner: Solving ODEs II,
/// IV.7]
///
/// The midpoint rule's equations with a single Newton step from
///
///     a* = a_{-1} + (h + h_{-1})/(h_{-1} + h_{-2}) (a_{-1} - a_{-2}),
///
/// the line through the accelerations at the last two midpoints. The error of a* is
/// O(h^2), and a tangent with wrong or missing dr/dv leaves O(h) times that: order 2
/// needs neither an exact Jacobian nor iteration. The first two steps iterate.
///
/// Error indicator: with equal steps a - a* is the second difference of the accelerations
/// at midpoints, h^2 a'' + O(h^3). The local error of the velocity is
///
///     integral of a over the step - h a(midpoint) = h^3/24 a'' + O(h^5),
///
/// which moves q by h times that during a step: h^2/24 |a - a*|. So it falls as h^4 if
/// the step resolves the motion, and it includes the error of the single Newton step. At
/// the stability limit a changes its sign from step to step and |a - a*| = 4 |a|. The
/// indicator is then h^2 |a|/6, a third of the effect of a step's acceleration on q.
class LinearlyImplicitMidpoint final : public FixedStep, public ErrorIndicator {
 public:
  LinearlyImplicitMidpoint(System& system, const Options& options)
      : FixedStep(system, options),
        stage_(dynamics_, options),
        a_last_(vector_n()),
        a_guess_(vector_n()),
        q_bar_(vector_n()),
        lambda_last_(lambda_) {}

  double largest_indicator() const override { return indicator_; }

 private:
  Status reset(double /*t*/) override {
    h_last_ = h_before_ = 0;
    if (dynamics_.stats.steps == 0) indicator_ = 0;  // a start, not an event
    return Status::ok;
  }

  Status step(double t, double h) override {
    shifted(q_bar_, q_, h / 2, v_);
    const Weights w{1, h / 2, h * h / 4};
    Status s = Status::ok;
    if (h_before_ == 0) {
      std::ranges::copy(a_, a_last_.begin());
      std::ranges::copy(lambda_, lambda_last_.begin());
      stage_.leave(t, q_);
      s = stage_.solve(t + h / 2, q_bar_, v_, w, a_, lambda_);
    } else {
      const double ahead = (h + h_last_) / (h_last_ + h_before_);
      extrapolate(ahead, a_last_, a_);
      extrapolate(ahead, lambda_last_, lambda_);
      std::ranges::copy(a_, a_guess_.begin());
      s = stage_.single_step(t + h / 2, q_bar_, v_, w, a_, a_, lambda_);
      indicate(h);
    }
    h_before_ = std::exchange(h_last_, h);
    add(q_, h, stage_.v());
    add(v_, h, a_);
    return s;
  }

  void indicate(double h) {
    add(a_guess_, -1, a_);
    indicator_ =
        std::max(indicator_, h * h / 24 * scaled_norm(a_guess_, dynamics_.q_typ()));
  }

  /// (last, x) -> (x, x + ahead (x - last))
  static void extrapolate(double ahead, InOut last, InOut x) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      last[i] = std::exchange(x[i], x[i] + ahead * (x[i] - last[i]));
    }
  }

  Stage stage_;
  double h_last_ = 0, h_before_ = 0;  // 0: no such step since the start
  double indicator_ = 0;
  std::vector<double> a_last_, a_guess_, q_bar_, lambda_last_;
};

}  // namespace

IntegratorEntry linearly_implicit_midpoint_entry() {
  return {.id = "linearly_implicit_midpoint",
          .summary = "one linear solve, with any Jacobian",
          .source = "Steihaug-Wolfbrandt 1979",
          .tangent = true,
          .formulations = of_order(2, projected_formulations),
          .gaps = {{Formulation::index3, "Gauss methods are unstable on index 3"}},
          .make = make_method<LinearlyImplicitMidpoint>};
}

}  // namespace tress::integrators
