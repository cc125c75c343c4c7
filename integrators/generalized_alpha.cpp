#include <algorithm>
#include <cmath>

#include "contract/forms/moving_history.h"
#include "integrators/control/step_sequence.h"
#include "integrators/controlled_stage.h"
#include "integrators/entry.h"
#include "integrators/fixed_step.h"
#include "integrators/one_step.h"
#include "integrators/stage/stage.h"

namespace tress::integrators {
namespace {

constexpr int order = 2;
/// Of the tolerance, in the estimate of a step. On strand_release of work_precision, it
/// leaves 0.04 to 0.63 of the tolerance (55 runs of 11 models).
constexpr double share = 0.75;
constexpr double velocity_part = 0.1;

constexpr Parameter own_generalized_alpha[] = {
    {.name = "rho_inf",
     .help = "spectral radius at infinity; with a tolerance 0.5 by default",
     .number = 0.9,
     .min = 0,
     .max = 1}};
struct Coefficients {
  double alpha_m, alpha_f, gamma, beta;
};

/// [Chung, Hulbert 1993, eq. (25)], optimal for a given spectral radius at infinity.
Coefficients chung_hulbert(double rho) {
  const double alpha_m = (2 * rho - 1) / (rho + 1);
  const double alpha_f = rho / (rho + 1);
  const double gamma = 0.5 + alpha_f - alpha_m;
  return {alpha_m, alpha_f, gamma, (gamma + 0.5) * (gamma + 0.5) / 4};
}

/// A step with a the algorithmic and u the true acceleration (the unknown of Stage):
///     (1 - alpha_m) a_{n+1} + alpha_m a_n = (1 - alpha_f) u_{n+1} + alpha_f u_n
///     q_{n+1} = q_n + h v_n + h^2 ((1/2 - beta) a_n + beta a_{n+1})
///     v_{n+1} = v_n + h ((1 - gamma) a_n + gamma a_{n+1})
/// Order 2, A-stable, spectral radius at infinity rho_inf. [Chung, Hulbert 1993;
/// constraints: Arnold, Bruls 2007, eqs. (4) to (6)]
///
/// Newmark's method is alpha_m = alpha_f = 0, where a = u; with average acceleration,
/// beta = 1/4 and gamma = 1/2, it has no damping. [Newmark 1959]
class AlphaStep {
 public:
  AlphaStep(Dynamics& dynamics, const Options& options, Stage::Ending ending,
            Coefficients coefficients)
      : k_(coefficients),
        stage_(dynamics, options, ending),
        u_(size(dynamics.n())),
        a_(u_),
        a_known_(u_),
        q_bar_(u_),
        v_bar_(u_) {}

  /// Steps from (q, v) at t, with accelerations u and a, over h. `guess`: of u at the
  /// end; `lambda`: guess in, solution out.
  Status step(double t, double h, In q, In v, In u, In a, In guess, InOut lambda,
              Effort effort) noexcept {
    const double ratio = (1 - k_.alpha_f) / (1 - k_.alpha_m);
    for (std::size_t i = 0; i < q.size(); ++i) {
      a_known_[i] = (k_.alpha_f * u[i] - k_.alpha_m * a[i]) / (1 - k_.alpha_m);
      q_bar_[i] =
          q[i] + h * v[i] + h * h * ((0.5 - k_.beta) * a[i] + k_.beta * a_known_[i]);
      v_bar_[i] = v[i] + h * ((1 - k_.gamma) * a[i] + k_.gamma * a_known_[i]);
    }
    std::ranges::copy(guess, u_.begin());
    const Weights w{1, h * k_.gamma * ratio, h * h * k_.beta * ratio};
    stage_.leave(t, q);
    const Status s =
        stage_.solve(t + h, q_bar_, v_bar_, w, u_, lambda, Stage::Matrix::own, effort);
    for (std::size_t i = 0; i < q.size(); ++i) a_[i] = a_known_[i] + ratio * u_[i];
    return s;
  }

  // The end of the last step.
  In q() const { return stage_.q(); }
  In v() const { return stage_.v(); }
  In u() const { return u_; }  // the true acceleration
  In a() const { return a_; }  // the algorithmic one

 private:
  Coefficients k_;
  Stage stage_;
  std::vector<double> u_, a_, a_known_, q_bar_, v_bar_;
};

/// The method with a fixed step.
class FixedAlpha final : public FixedStep {
 public:
  FixedAlpha(System& system, const Options& options, Coefficients coefficients)
      : FixedStep(system, options),
        step_(dynamics_, options, {}, coefficients),
        u_(vector_n()) {}

  std::vector<InOut> state() override { return {q_, v_, u_, a_}; }

 private:
  Status reset(double t) override {
    const Status s = dynamics_.accelerate(t, q_, v_, u_, lambda_);
    a_ = u_;
    return s;
  }

  Status go_on_changed(double t) override {
    for (std::vector<double>* of : {&u_, &a_}) {
      std::vector<double> q(step_.q().begin(), step_.q().end());
      std::vector<double> v(step_.v().begin(), step_.v().end());
      if (!carry(dynamics_.system(), t, q, v, *of)) return reset(t);
    }
    return Status::ok;
  }

  Status step(double t, double h) override {
    const Status s = step_.step(t, h, q_, v_, u_, a_, u_, lambda_, Effort::whole);
    std::ranges::copy(step_.u(), u_.begin());
    std::ranges::copy(step_.a(), a_.begin());
    take(step_.q(), step_.v());
    return s;
  }

  AlphaStep step_;
  std::vector<double> u_;
};

/// Steps of any length, which remember the algorithmic acceleration. It is that of the
/// time t_n + (alpha_m - alpha_f) h. After a step of another length it is moved there
/// along a line, since v has an error of order h^2 otherwise.
///
/// The estimated error of q in a step is beta + (alpha_m - alpha_f)/2 - 1/6 times h^2
/// times the change of the algorithmic acceleration [Zienkiewicz, Xie 1991]. That of v is
/// a tenth of its difference to the trapezoidal rule, which stiff oscillations enter. On
/// strand_release, the whole of it multiplies the steps by 1.3 to 2.9 and leaves 0.01
/// to 0.13 of the tolerance. Without it, der has up to 1.3 tolerances of error.
class AlphaMemory {
 public:
  AlphaMemory(Dynamics& dynamics, const Options& options, Coefficients k)
      : error_(k.beta + (k.alpha_m - k.alpha_f) / 2 - 1. / 6),
        step_(
            dynamics,
            controlled_options(dynamics, options, second_order_threshold(options, share)),
            controlled_ending(dynamics), k),
        a_(size(dynamics.n())),
        a_end_(a_),
        v_(a_),
        u_(a_),
        u_before_(a_),
        guess_(a_),
        lambda_(size(dynamics.m())) {}

  Status step(double t, double h, In q, In v, In u, In lambda, Effort effort) noexcept {
    const StepSequence::Start start = steps_.begin(t, h);
    if (start != StepSequence::Start::again) {
      std::ranges::copy(start == StepSequence::Start::next ? step_.a() : u,
                        a_end_.begin());
      u_before_.swap(u_);
    }
    std::ranges::copy(v, v_.begin());
    std::ranges::copy(u, u_.begin());
    std::ranges::copy(lambda, lambda_.begin());
    const double w = steps_.ratio() > 0 ? steps_.ratio() : 1;
    for (std::size_t i = 0; i < u.size(); ++i) {
      a_[i] = u[i] + w * (a_end_[i] - u[i]);
      guess_[i] = u[i] + steps_.ratio() * (u[i] - u_before_[i]);
    }
    return step_.step(t, h, q, v, u, a_, guess_, lambda_, effort);
  }

  void forget() { steps_.forget(); }

  In q() const { return step_.q(); }
  In v() const { return step_.v(); }
  In a() const { return step_.u(); }
  In lambda() const { return lambda_; }

  Status difference(Out dq, Out dv) const noexcept {
    const double h = steps_.length();
    for (std::size_t i = 0; i < dq.size(); ++i) {
      dq[i] = error_ * h * h * (step_.a()[i] - a_[i]);
      dv[i] = velocity_part * (v()[i] - v_[i] - h / 2 * (u_[i] + step_.u()[i]));
    }
    return Status::ok;
  }

 private:
  double error_;
  AlphaStep step_;
  StepSequence steps_;
  std::vector<double> a_;      // at the start of the step
  std::vector<double> a_end_;  // at the end of the step before
  std::vector<double> v_, u_;  // at the start of the step
  std::vector<double> u_before_, guess_, lambda_;
};

/// rho_inf of `options`; with a tolerance 0.5 where none was chosen. With 0.9, the errors
/// of 15 runs in 20 of strand_release are 0.05 to 1 of the tolerance, with 0.5 of 19.
double radius(const Options& options) {
  if (options.tolerance > 0 && !options.own.contains("rho_inf")) return 0.5;
  return own_options(options, own_generalized_alpha).number("rho_inf");
}

std::unique_ptr<Integrator> make_generalized_alpha(System& system,
                                                   const Options& options) {
  const Coefficients k = chung_hulbert(radius(options));
  if (options.tolerance == 0) return std::make_unique<FixedAlpha>(system, options, k);
  check_controlled(system, options);
  return std::make_unique<ControlledOneStep<AlphaMemory>>(
      system, options, second_order_power, second_order_threshold(options, share),
      options, k);
}

std::unique_ptr<Integrator> make_newmark(System& system, const Options& options) {
  return std::make_unique<FixedAlpha>(system, options, Coefficients{0, 0, 0.5, 0.25});
}

}  // namespace

IntegratorEntry newmark_entry() {
  return {.id = "newmark",
          .summary = "average acceleration, no damping",
          .source = "Newmark 1959",
          .tangent = true,
          .stages = 1,
          .formulations = of_order(order, stage_formulations),
          .make = make_newmark};
}

IntegratorEntry generalized_alpha_entry() {
  return {.id = "generalized_alpha",
          .summary = "damping by rho_inf",
          .source = "Chung-Hulbert 1993",
          .error_controlled = true,
          .tangent = true,
          .stages = 1,
          .formulations = of_order(order, stage_formulations),
          .parameters = own_generalized_alpha,
          .make = make_generalized_alpha};
}

}  // namespace tress::integrators
