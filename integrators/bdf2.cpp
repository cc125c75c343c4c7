#include <algorithm>
#include <cmath>

#include "contract/forms/moving_history.h"
#include "integrators/bdf2_formula.h"
#include "integrators/control/step_sequence.h"
#include "integrators/controlled_stage.h"
#include "integrators/entry.h"
#include "integrators/fixed_step.h"
#include "integrators/one_step.h"
#include "integrators/stage/stage.h"
#include "linear/vector_ops.h"

namespace tress::integrators {
namespace {

constexpr int order = 2;
/// Of the tolerance, in the estimate of a step. On strand_release of work_precision, it
/// leaves 0.05 to 0.44 of the tolerance (55 runs of 11 models).
constexpr double share = 1.8;
/// Impacts make velocities jump, and the formula would carry the jump on.
constexpr Contact controlled_contact = Contact::regular;

/// Bdf2Formula for y = q and y = v, started by backward Euler. Order 2, L-stable, damps
/// high frequencies. A step in which a rigid contact stops points (Stage::stops) is a
/// backward Euler step, and so is the next one. Through the position before the impact
/// the formula would throw a point back, by up to half its speed.
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

  std::vector<InOut> state() override { return {q_, v_, q_previous_, v_previous_}; }
  std::vector<double*> numbers() override { return {&h_previous_}; }

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
    const double gently = Stage::gentle_speed(h);
    stage_.leave(t, q_);
    stage_.places(t, q_, v_, place_);
    bool impact = stage_.stops(t, q_, v_, gently);
    const double ratio = h_previous_ > 0 && !impact ? h / h_previous_ : 0;
    Status s = solve(t, h, ratio);
    if (!impact && s != Status::fatal && stage_.stops(t, q_, v_, gently)) {
      impact = true;
      std::ranges::fill(a_, 0.0);
      if (ratio > 0) s = solve(t, h, 0);
    }
    place_previous_ = place_;
    q_previous_ = q_;
    v_previous_ = v_;
    h_previous_ = impact ? 0 : h;
    take(stage_.q(), stage_.v());
    return s;
  }

  /// With the step over the one before, 0: by backward Euler.
  Status solve(double t, double h, double ratio) {
    const auto [c0, c1, bh] = Bdf2Formula(h, ratio);
    for (std::size_t i = 0; i < q_.size(); ++i) {
      v_bar_[i] = c0 * v_[i] - c1 * v_previous_[i];
      q_bar_[i] = c0 * q_[i] - c1 * q_previous_[i] + bh * v_bar_[i];
    }
    for (std::size_t i = 0; i < place_.size(); ++i) {
      stage_.place_bar()[i] = c0 * place_[i] - c1 * place_previous_[i];
    }
    return stage_.solve(t + h, q_bar_, v_bar_, {1, bh, bh * bh}, a_, lambda_);
  }

  Stage stage_;
  double h_previous_ = 0;
  std::vector<double> q_bar_, v_bar_, q_previous_, v_previous_;
  std::vector<double> place_, place_previous_;  // along bodies
};

/// Steps of any length, which remember the step before, or start by backward Euler.
///
/// The errors of a step are K q''' + b h K v''' of q and K v''' of v, with K = h^3
/// (1 + w)^2/(6 w (1 + 2w)). The derivatives are second divided differences of v and a.
/// The errors of the first step are h/2 times the changes of v and a.
class Bdf2Memory {
 public:
  Bdf2Memory(Dynamics& dynamics, const Options& options)
      : stage_(
            dynamics,
            controlled_options(dynamics, options, second_order_threshold(options, share)),
            controlled_ending(dynamics)),
        start_(size(dynamics.n())),
        before_(start_),
        q_bar_(start_.q),
        v_bar_(q_bar_),
        a_(q_bar_),
        lambda_(size(dynamics.m())) {}

  Status step(double t, double h, In q, In v, In a, In lambda, Effort effort) noexcept {
    if (steps_.begin(t, h) != StepSequence::Start::again) std::swap(start_, before_);
    start_.take(q, v, a);
    std::ranges::copy(lambda, lambda_.begin());
    const double w = steps_.ratio();
    const auto [c0, c1, bh] = Bdf2Formula(h, w);
    for (std::size_t i = 0; i < q.size(); ++i) {
      v_bar_[i] = c0 * v[i] - c1 * before_.v[i];
      q_bar_[i] = c0 * q[i] - c1 * before_.q[i] + bh * v_bar_[i];
      a_[i] = a[i] + w * (a[i] - before_.a[i]);
    }
    stage_.leave(t, q);
    return stage_.solve(t + h, q_bar_, v_bar_, {1, bh, bh * bh}, a_, lambda_,
                        Stage::Matrix::own, effort);
  }

  void forget() { steps_.forget(); }

  In q() const { return stage_.q(); }
  In v() const { return stage_.v(); }
  In a() const { return a_; }
  In lambda() const { return lambda_; }

  Status difference(Out dq, Out dv) const noexcept {
    const double w = steps_.ratio(), h = steps_.length();
    for (std::size_t i = 0; i < dq.size(); ++i) {
      const double of_v = v()[i] - start_.v[i], of_a = a_[i] - start_.a[i];
      if (w == 0) {
        dq[i] = h / 2 * of_v;
        dv[i] = h / 2 * of_a;
        continue;
      }
      // Second divided differences times h^2 h_before (1 + w) / 2.
      const double v2 = of_v - w * (start_.v[i] - before_.v[i]);
      const double a2 = of_a - w * (start_.a[i] - before_.a[i]);
      const double k = h * (1 + w) / (3 * (1 + 2 * w));
      dv[i] = k * a2;
      dq[i] = k * v2 + (1 + w) / (1 + 2 * w) * h * dv[i];
    }
    return Status::ok;
  }

 private:
  struct Known {
    explicit Known(std::size_t n) : q(n), v(n), a(n) {}
    void take(In q_now, In v_now, In a_now) {
      std::ranges::copy(q_now, q.begin());
      std::ranges::copy(v_now, v.begin());
      std::ranges::copy(a_now, a.begin());
    }
    std::vector<double> q, v, a;
  };

  Stage stage_;
  StepSequence steps_;
  Known start_, before_;  // of the last step, of the step before
  std::vector<double> q_bar_, v_bar_, a_, lambda_;
};

std::unique_ptr<Integrator> make_bdf2(System& system, const Options& options) {
  if (options.tolerance == 0) return std::make_unique<Bdf2>(system, options);
  check_controlled(system, options, controlled_contact);
  return std::make_unique<ControlledOneStep<Bdf2Memory>>(
      system, options, second_order_power, second_order_threshold(options, share),
      options);
}

}  // namespace

IntegratorEntry bdf2_entry() {
  return {.id = "bdf2",
          .summary = "L-stable, damps fast modes",
          .source = "Gear 1971",
          .error_controlled = true,
          .tangent = true,
          .stages = 1,
          .contact = Contact::exact,
          .controlled_contact = controlled_contact,
          .formulations = of_order(order, stage_formulations),
          .make = make_bdf2};
}

}  // namespace tress::integrators
