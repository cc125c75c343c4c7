#include <algorithm>

#include "contract/forms/moving_history.h"
#include "integrators/bdf2_formula.h"
#include "integrators/entry.h"
#include "integrators/fixed_step.h"
#include "integrators/stage/stage.h"
#include "linear/vector_ops.h"

namespace tress::integrators {
namespace {

/// Bdf2Formula for y = q and y = v, started by backward Euler. Order 2, L-stable, damps
/// high frequencies.
class Bdf2 final : public FixedStep {
 public:
  Bdf2(System& system, const Options& options)
      : FixedStep(system, options),
        stage_(dynamics_, options),
        q_bar_(vector_n()),
        v_bar_(vector_n()),
        q_previous_(vector_n()),
        v_previous_(vector_n()),
        place_(stage_.place_bar().size()),
        place_previous_(place_) {}

  std::vector<InOut> state() override {
    return {q_, v_, q_previous_, v_previous_, {&h_previous_, 1}};
  }

 private:
  Status reset(double /*t*/) override {
    h_previous_ = 0;
    return Status::ok;
  }

  Status go_on_changed(double t) override {
    std::ranges::fill(v_bar_, 0.0);  // the formula has no accelerations
    const bool carried =
        carry(dynamics_.system(), t - h_previous_, q_previous_, v_previous_, v_bar_);
    return carried ? Status::ok : reset(t);
  }

  Status step(double t, double h) override {
    const auto [c0, c1, bh] = Bdf2Formula(h, h_previous_ > 0 ? h / h_previous_ : 0);
    for (std::size_t i = 0; i < q_.size(); ++i) {
      v_bar_[i] = c0 * v_[i] - c1 * v_previous_[i];
      q_bar_[i] = c0 * q_[i] - c1 * q_previous_[i] + bh * v_bar_[i];
    }
    stage_.leave(t, q_);
    stage_.places(t, q_, v_, place_);
    for (std::size_t i = 0; i < place_.size(); ++i) {
      stage_.place_bar()[i] = c0 * place_[i] - c1 * place_previous_[i];
    }
    place_previous_ = place_;
    const Status s = stage_.solve(t + h, q_bar_, v_bar_, {1, bh, bh * bh}, a_, lambda_);
    q_previous_ = q_;
    v_previous_ = v_;
    h_previous_ = h;
    take(stage_.q(), stage_.v());
    return s;
  }

  Stage stage_;
  double h_previous_ = 0;
  std::vector<double> q_bar_, v_bar_, q_previous_, v_previous_;
  std::vector<double> place_, place_previous_;  // along bodies
};

}  // namespace

IntegratorEntry bdf2_entry() {
  return {.id = "bdf2",
          .summary = "L-stable, damps fast modes",
          .source = "Gear 1971",
          .tangent = true,
          .stages = 1,
          .contact = Contact::exact,
          .formulations = of_order(2, stage_formulations),
          .make = make_method<Bdf2>};
}

}  // namespace tress::integrators
