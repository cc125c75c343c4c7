#include <numbers>

#include "example.h"
#include "integrators/fixed_step.h"
#include "integrators/stage/stage.h"
#include "linear/vector_ops.h"

namespace example {
namespace {

using namespace tress;
using namespace tress::integrators;

constexpr double diagonal = 1 - std::numbers::sqrt2 / 2;

/// The two-stage SDIRK method of order 2 that is L-stable [Alexander 1977, SIAM J. Numer.
/// Anal. 14, 1006], with g = 1 - sqrt 2/2. One matrix serves both stages, the second is
/// the end of the step:
///
///     v_1 = v + h g a_1,                   q_1 = q + h g v_1
///     v_2 = v + h (1 - g) a_1 + h g a_2,   q_2 = q + h (1 - g) v_1 + h g v_2
///
/// Where a strand is so stiff that it follows a constraint, the order is that of a stage,
/// one; methods with an explicit first stage keep theirs.
class Sdirk2 final : public FixedStep {
 public:
  Sdirk2(System& system, const Options& options)
      : FixedStep(system, options),
        stage_(dynamics_, options),
        q_bar_(vector_n()),
        v_bar_(vector_n()) {}

 private:
  Status step(double t, double h) override {
    const double part = diagonal * h, rest = h - part;
    const Weights weights{1, part, part * part};
    shifted(q_bar_, q_, part, v_);
    const Status first = stage_.solve(t + part, q_bar_, v_, weights, a_, lambda_);
    if (first != Status::ok) return first;
    shifted(v_bar_, v_, rest, a_);
    shifted(q_bar_, q_, rest, stage_.v());
    add(q_bar_, part, v_bar_);
    const Status second =
        stage_.solve(t + h, q_bar_, v_bar_, weights, a_, lambda_, Stage::Matrix::shared);
    take(stage_.q(), stage_.v());
    return second;
  }

  Stage stage_;
  std::vector<double> q_bar_, v_bar_;
};

}  // namespace

IntegratorEntry sdirk2_entry() {
  std::vector<Treatment> formulations = of_order(2, projected_formulations);
  formulations.push_back({Formulation::index3, 1});
  return {.id = "sdirk2",
          .summary = "L-stable, two solves with one matrix",
          .source = "Alexander 1977",
          .tangent = true,
          .stages = 2,
          .formulations = std::move(formulations),
          .make = make_method<Sdirk2>};
}

}  // namespace example
