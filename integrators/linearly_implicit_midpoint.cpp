#include <algorithm>
#include <utility>

#include "integrators/fixed_step.h"
#include "integrators/methods.h"
#include "integrators/stage.h"
#include "integrators/vector_ops.h"

namespace tress {
namespace {

/// The midpoint rule's equations with a single Newton step from
///
///     a* = a_{-1} + (h + h_{-1})/(h_{-1} + h_{-2}) (a_{-1} - a_{-2}),
///
/// the line through the accelerations at the last two midpoints. a* is O(h^2) off, and a
/// tangent whose dr/dv is wrong or missing leaves O(h) of that: order 2 needs neither an
/// exact tangent nor an iteration. The first two steps iterate.
class LinearlyImplicitMidpoint final : public FixedStep {
 public:
  LinearlyImplicitMidpoint(System& system, const Options& options)
      : FixedStep(system, options),
        stage_(dynamics_, options),
        a_last_(vector_n()),
        q_bar_(vector_n()),
        lambda_last_(lambda_) {}

 private:
  Status reset(double /*t*/) override {
    h_last_ = h_before_ = 0;
    return Status::ok;
  }

  Status step(double t, double h) override {
    shifted(q_bar_, q_, h / 2, v_);
    const Weights w{1, h / 2, h * h / 4};
    Status s = Status::ok;
    if (h_before_ == 0) {
      std::ranges::copy(a_, a_last_.begin());
      std::ranges::copy(lambda_, lambda_last_.begin());
      s = stage_.solve(t + h / 2, q_bar_, v_, w, a_, lambda_);
    } else {
      const double ahead = (h + h_last_) / (h_last_ + h_before_);
      extrapolate(ahead, a_last_, a_);
      extrapolate(ahead, lambda_last_, lambda_);
      s = stage_.single_step(t + h / 2, q_bar_, v_, w, a_, a_, lambda_);
    }
    h_before_ = std::exchange(h_last_, h);
    add(q_, h, stage_.v());
    add(v_, h, a_);
    return s;
  }

  /// (last, x) -> (x, x + ahead (x - last))
  static void extrapolate(double ahead, InOut last, InOut x) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      last[i] = std::exchange(x[i], x[i] + ahead * (x[i] - last[i]));
    }
  }

  Stage stage_;
  double h_last_ = 0, h_before_ = 0;  // 0: no such step since the start
  std::vector<double> a_last_, q_bar_, lambda_last_;
};

}  // namespace

std::unique_ptr<Integrator> make_linearly_implicit_midpoint(System& system,
                                                            const Options& options) {
  return std::make_unique<LinearlyImplicitMidpoint>(system, options);
}

}  // namespace tress
