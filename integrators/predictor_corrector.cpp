#include "integrators/entry.h"
#include "integrators/fixed_step.h"
#include "integrators/formulation/relaxation.h"
#include "integrators/linearly_implicit_step.h"

namespace tress::integrators {
namespace {

constexpr Parameter own_predictor_corrector[] = {
    // The impulse that would have caused the correction [Bridson et al. 2002], or no
    // change of the velocity [Provot 1995].
    {.name = "correction",
     .help = "correction of the positions with an impulse, or alone",
     .choices = "impulse|position"},
    {.name = "second_filter",
     .help = "an implicit solve after the correction",
     .choices = "true|false"},
    {.name = "correction_tolerance",
     .help = "largest violation over its scale",
     .number = 1e-8,
     .min = 1e-15,
     .max = 1},
};

/// Two linearly implicit half steps without constraints. Between them the positions are
/// corrected, one constraint after the other, until all constraints are satisfied. Film
/// production uses this method to keep hair from stretching. Order 1. Without constraints
/// its amplification has determinant (1 + z^2/4)^-2: it damps half as much as
/// linearly_implicit_euler. [Kim 2010, in: Realistic Hair Simulation, SIGGRAPH course,
/// five steps; Provot 1995; Bridson et al. 2002]
///
/// The five steps, with a(q, v) the acceleration of an unconstrained linearly implicit
/// half step from (q, v):
///
///     1  v_m = v_n + h/2 a(q_n, v_n)          the first implicit filter
///     2  q*  = q_n + h v_m
///     3  q_{n+1}: g = 0, by relaxation from q*
///     4  v_m += (q_{n+1} - q*)/h              the impulse
///     5  v_{n+1} = v_m + h/2 a(q_{n+1}, v_m)  the second implicit filter
///
/// On x'' = -omega^2 x, with z = h omega and s = 1/(1 + z^2/4), the step has trace 3 s^2
/// - 1 and determinant s^2: stable for every z.
class PredictorCorrector final : public FixedStep {
 public:
  PredictorCorrector(System& system, const Options& options)
      : PredictorCorrector(system, options,
                           own_options(options, own_predictor_corrector)) {}

 private:
  PredictorCorrector(System& system, const Options& options, const Parameters& chosen)
      : FixedStep(system, options),
        impulse_(chosen.word("correction") == "impulse"),
        second_filter_(chosen.word("second_filter") == "true"),
        filter_(dynamics_, options),
        relaxation_(system, chosen.number("correction_tolerance")),
        predicted_(vector_n()) {}

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
    if (impulse_) {
      for (std::size_t i = 0; i < v_.size(); ++i) v_[i] += (q_[i] - predicted_[i]) / h;
    }
    return second_filter_ ? filter(t + h, h) : Status::ok;
  }

  bool impulse_, second_filter_;
  LinearlyImplicitStep filter_;
  Relaxation relaxation_;
  std::vector<double> predicted_;
};

/// Constraints solved one at a time weight coordinates, not directions.
std::string weighs_coordinates(System& system, Formulation formulation) {
  if (!diagonal_mass(system)) return "needs a diagonal mass matrix";
  return constant_mass(system, formulation);
}

}  // namespace

IntegratorEntry predictor_corrector_entry() {
  return {.id = "predictor_corrector",
          .summary = "lengths corrected between two implicit half steps",
          .source = "Kim 2010; Provot 1995; Bridson 2002",
          .tangent = true,
          .formulations = {{Formulation::correction, 1}},
          .gaps = holds_constraints("has no constraint to correct"),
          .parameters = own_predictor_corrector,
          .objection = weighs_coordinates,
          .make = make_method<PredictorCorrector>};
}

}  // namespace tress::integrators
