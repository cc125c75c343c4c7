#include "integrators/fixed_step.h"
#include "integrators/formulation/relaxation.h"
#include "integrators/methods.h"
#include "integrators/semi_implicit_step.h"

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
        filter_(dynamics_, options),
        relaxation_(system, options.correction_tolerance),
        predicted_(vector_n()) {}

 private:
  Status reset(double /*t*/) override {
    filter_.reset();
    return Status::ok;
  }

  /// v_ += h/2 a(q_, v_), from time t on.
  Status filter(double t, double h) {
    const Status s = filter_.take(t, h / 2, q_, v_, {});
    std::ranges::copy(filter_.v(), v_.begin());
    return s;
  }

  Status step(double t, double h) override {
    if (const Status s = filter(t, h); s != Status::ok) return s;
    add(q_, h, v_);
    predicted_ = q_;
    const long before = relaxation_.sweeps();
    const Status corrected = relaxation_.positions(t + h, q_);
    dynamics_.stats.sweeps += relaxation_.sweeps() - before;
    if (corrected != Status::ok) return corrected;
    if (options_.correction == Correction::impulse) {
      for (std::size_t i = 0; i < v_.size(); ++i) v_[i] += (q_[i] - predicted_[i]) / h;
    }
    return options_.second_filter ? filter(t + h, h) : Status::ok;
  }

  SemiImplicitStep filter_;
  Relaxation relaxation_;
  std::vector<double> predicted_;
};

}  // namespace

std::unique_ptr<Integrator> make_predictor_corrector(System& system,
                                                     const Options& options) {
  return std::make_unique<PredictorCorrector>(system, options);
}

}  // namespace tress
