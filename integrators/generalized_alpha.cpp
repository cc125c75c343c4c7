#include "contract/forms/moving_history.h"
#include "integrators/entry.h"
#include "integrators/fixed_step.h"
#include "integrators/stage/stage.h"

namespace tress::integrators {
namespace {

constexpr Parameter own_generalized_alpha[] = {{.name = "rho_inf",
                                                .help = "spectral radius at infinity",
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

/// With a the algorithmic and u the true acceleration (the unknown of Stage):
///     (1 - alpha_m) a_{n+1} + alpha_m a_n = (1 - alpha_f) u_{n+1} + alpha_f u_n
///     q_{n+1} = q_n + h v_n + h^2 ((1/2 - beta) a_n + beta a_{n+1})
///     v_{n+1} = v_n + h ((1 - gamma) a_n + gamma a_{n+1})
/// Order 2, A-stable, spectral radius at infinity rho_inf. [Chung, Hulbert 1993;
/// constraints: Arnold, Bruls 2007, eqs. (4) to (6)]
///
/// Newmark's method is alpha_m = alpha_f = 0, where a = u; with average acceleration,
/// beta = 1/4 and gamma = 1/2, it has no damping. [Newmark 1959]
class GeneralizedAlpha final : public FixedStep {
 public:
  GeneralizedAlpha(System& system, const Options& options, Coefficients coefficients)
      : FixedStep(system, options),
        k_(coefficients),
        stage_(dynamics_, options),
        u_(vector_n()),
        a_known_(vector_n()),
        q_bar_(vector_n()),
        v_bar_(vector_n()) {}

  std::vector<InOut> state() override { return {q_, v_, u_, a_}; }

 private:
  Status reset(double t) override {
    const Status s = dynamics_.accelerate(t, q_, v_, u_, lambda_);
    a_ = u_;
    return s;
  }

  Status go_on_changed(double t) override {
    for (std::vector<double>* of : {&u_, &a_}) {
      q_bar_.assign(stage_.q().begin(), stage_.q().end());
      v_bar_.assign(stage_.v().begin(), stage_.v().end());
      if (!carry(dynamics_.system(), t, q_bar_, v_bar_, *of)) return reset(t);
    }
    return Status::ok;
  }

  Status step(double t, double h) override {
    const double ratio = (1 - k_.alpha_f) / (1 - k_.alpha_m);
    for (std::size_t i = 0; i < q_.size(); ++i) {
      a_known_[i] = (k_.alpha_f * u_[i] - k_.alpha_m * a_[i]) / (1 - k_.alpha_m);
      q_bar_[i] =
          q_[i] + h * v_[i] + h * h * ((0.5 - k_.beta) * a_[i] + k_.beta * a_known_[i]);
      v_bar_[i] = v_[i] + h * ((1 - k_.gamma) * a_[i] + k_.gamma * a_known_[i]);
    }
    const Weights w{1, h * k_.gamma * ratio, h * h * k_.beta * ratio};
    stage_.leave(t, q_);
    const Status s = stage_.solve(t + h, q_bar_, v_bar_, w, u_, lambda_);
    for (std::size_t i = 0; i < q_.size(); ++i) a_[i] = a_known_[i] + ratio * u_[i];
    take(stage_.q(), stage_.v());
    return s;
  }

  Coefficients k_;
  Stage stage_;
  std::vector<double> u_, a_known_, q_bar_, v_bar_;
};

std::unique_ptr<Integrator> make_generalized_alpha(System& system,
                                                   const Options& options) {
  const double rho_inf = own_options(options, own_generalized_alpha).number("rho_inf");
  return std::make_unique<GeneralizedAlpha>(system, options, chung_hulbert(rho_inf));
}

std::unique_ptr<Integrator> make_newmark(System& system, const Options& options) {
  return std::make_unique<GeneralizedAlpha>(system, options,
                                            Coefficients{0, 0, 0.5, 0.25});
}

}  // namespace

IntegratorEntry newmark_entry() {
  return {.id = "newmark",
          .summary = "average acceleration, no damping",
          .source = "Newmark 1959",
          .tangent = true,
          .stages = 1,
          .formulations = of_order(2, stage_formulations),
          .make = make_newmark};
}

IntegratorEntry generalized_alpha_entry() {
  return {.id = "generalized_alpha",
          .summary = "damping by rho_inf",
          .source = "Chung-Hulbert 1993",
          .tangent = true,
          .stages = 1,
          .formulations = of_order(2, stage_formulations),
          .parameters = own_generalized_alpha,
          .make = make_generalized_alpha};
}

}  // namespace tress::integrators
