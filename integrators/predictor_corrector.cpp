#include <algorithm>

#include "integrators/fixed_step.h"
#include "integrators/formulation/relaxation.h"
#include "integrators/methods.h"
#include "integrators/stage.h"
#include "integrators/vector_ops.h"

namespace tress {
namespace {

/// The five steps, with a(q, v) the acceleration of a semi-implicit half step from (q, v)
/// that leaves the constraints out:
///
///     1  v_m = v_n + h/2 a(q_n, v_n)          the first implicit filter
///     2  q*  = q_n + h v_m
///     3  q_{n+1}: g = 0, by relaxation from q*
///     4  v_m += (q_{n+1} - q*)/h              the impulse
///     5  v_{n+1} = v_m + h/2 a(q_{n+1}, v_m)  the second implicit filter
///
/// On x'' = -omega^2 x, with z = h omega and s = 1/(1 + z^2/4), the step has trace
/// 3 s^2 - 1 and determinant s^2: stable for every z.
class PredictorCorrector final : public FixedStep {
 public:
  PredictorCorrector(System& system, const Options& options)
      : FixedStep(system, options),
        stage_(dynamics_, options),
        relaxation_(system, options.correction_tolerance),
        a_(vector_n()),
        a_last_(vector_n()),
        q_bar_(vector_n()) {}

 private:
  Status reset(double /*t*/) override {
    std::ranges::fill(a_, 0.0);
    return Status::ok;
  }

  /// v_ += h/2 a(q_, v_), from time t on.
  Status filter(double t, double h) {
    shifted(q_bar_, q_, h / 2, v_);
    std::swap(a_, a_last_);
    std::ranges::fill(a_, 0.0);
    const Status s =
        stage_.single_step(t + h / 2, q_bar_, v_, {1, h / 2, h * h / 4}, a_last_, a_, {});
    add(v_, h / 2, a_);
    return s;
  }

  Status step(double t, double h) override {
    if (const Status s = filter(t, h); s != Status::ok) return s;
    add(q_, h, v_);
    q_bar_ = q_;
    const long before = relaxation_.sweeps();
    const Status corrected = relaxation_.positions(t + h, q_);
    dynamics_.stats.sweeps += relaxation_.sweeps() - before;
    if (corrected != Status::ok) return corrected;
    if (options_.correction == Correction::impulse) {
      for (std::size_t i = 0; i < v_.size(); ++i) v_[i] += (q_[i] - q_bar_[i]) / h;
    }
    return options_.second_filter ? filter(t + h, h) : Status::ok;
  }

  Stage stage_;
  Relaxation relaxation_;
  std::vector<double> a_, a_last_, q_bar_;
};

}  // namespace

std::unique_ptr<Integrator> make_predictor_corrector(System& system,
                                                     const Options& options) {
  return std::make_unique<PredictorCorrector>(system, options);
}

}  // namespace tress
