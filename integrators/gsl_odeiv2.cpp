#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "integrators/entry.h"
#include "integrators/formulation/dynamics.h"
#include "integrators/formulation/projection.h"
#include "linear/finite.h"
#include "linear/vector_ops.h"

namespace tress::integrators {
namespace {

struct Free {
  void operator()(gsl_odeiv2_driver* driver) const { gsl_odeiv2_driver_free(driver); }
};

// eps^(1/3): balances truncation and rounding of a central difference.
constexpr double difference = 6e-6;

// More consecutive steps than any start-up needs.
constexpr int most_tiny_steps = 1000;

int gsl_code(Status s) {
  switch (s) {
    case Status::ok:
      return GSL_SUCCESS;
    case Status::retry:
      return GSL_FAILURE;  // GSL halves the step
    case Status::fatal:
      break;
  }
  return GSL_EBADFUNC;  // GSL stops
}

/// y = (q, v), y' = (v, a(t, q, v)), stepped by GSL's evolve with its own step control:
/// the error of entry i is kept below rtol |y_i| + atol typ_i.
class GslOdeiv2 final : public Integrator {
 public:
  GslOdeiv2(System& system, const Options& options, const gsl_odeiv2_step_type* type)
      : options_(options),
        dynamics_(system, options),
        n_(static_cast<std::size_t>(dynamics_.n())),
        y_(2 * n_),
        shifted_(2 * n_),
        a_(n_),
        a_shifted_(n_),
        lambda_(static_cast<std::size_t>(dynamics_.m())),
        ode_{&rhs, &jacobian, 2 * n_, this} {
    gsl_set_error_handler_off();
    std::vector<double> typical(dynamics_.q_typ().begin(), dynamics_.q_typ().end());
    typical.insert(typical.end(), dynamics_.v_typ().begin(), dynamics_.v_typ().end());
    driver_.reset(gsl_odeiv2_driver_alloc_scaled_new(
        &ode_, type, first_step(), options.atol, options.rtol, 1, 0, typical.data()));
    if (options.max_step > 0) gsl_odeiv2_driver_set_hmax(driver_.get(), options.max_step);
    if (options.formulation == Formulation::projection) projection_.emplace(dynamics_);
  }

  Status start(double t, In q, In v) override {
    std::copy(q.begin(), q.end(), y_.begin());
    std::copy(v.begin(), v.end(), y_.begin() + static_cast<std::ptrdiff_t>(n_));
    t_ = t;
    h_ = first_step();
    failure_.clear();
    limit_ = Limit::none;
    dynamics_.begin();
    gsl_odeiv2_driver_reset(driver_.get());
    return Status::ok;
  }

  Status advance(double t_end, const Observer& each_step) override {
    const long most = dynamics_.stats.steps + options_.max_steps;
    const double too_small = 1e-12 * (t_end - t_);
    int stuck = 0;
    while (t_ < t_end) {
      if (dynamics_.stats.steps >= most) {
        limit_ = Limit::steps;
        return fail("more than max_steps steps needed");
      }
      if (work_used_up(options_, dynamics_.stats, dynamics_.n())) {
        limit_ = Limit::work;
        return end("max_work used up");
      }
      if (options_.max_step > 0) h_ = std::min(h_, options_.max_step);
      const double before = t_;
      const int code = gsl_odeiv2_evolve_apply(driver_->e, driver_->c, driver_->s, &ode_,
                                               &t_, t_end, &h_, y_.data());
      if (code != GSL_SUCCESS) return fail(gsl_strerror(code));
      ++dynamics_.stats.steps;
      stuck = t_ - before < too_small ? stuck + 1 : 0;
      if (stuck > most_tiny_steps) return fail("stuck: steps below 1e-12 of the run");
      if (!(h_ > 0) || !all_finite(y_)) return fail("state not finite");
      if (projection_ && projection_->project(t_, q_part(), v_part()) != Status::ok) {
        return fail("projection onto the constraints failed");
      }
      if (dynamics_.system().accept(t_, q_part(), v_part())) {
        gsl_odeiv2_driver_reset(driver_.get());
      }
      if (stuck == 0) dynamics_.forget();
      if (each_step && !each_step(t_, q(), v())) return end("stopped");
    }
    return Status::ok;
  }

  double time() const override { return t_; }
  In q() const override { return In(y_).first(n_); }
  In v() const override { return In(y_).last(n_); }
  std::string failure() const override { return failure_; }
  Limit limit() const override { return limit_; }

  Stats stats() const override {
    Stats s = dynamics_.stats;
    s.rejected = static_cast<long>(driver_->e->failed_steps);
    return s;
  }

 private:
  /// Small against every scale of the tolerance; step control grows it at once.
  double first_step() const { return 1e-3 * std::pow(options_.rtol, 0.25); }

  InOut q_part() { return InOut(y_).first(n_); }
  InOut v_part() { return InOut(y_).last(n_); }

  Status end(const char* what) {
    char text[32];
    std::snprintf(text, sizeof text, " at t = %.9g s", t_);
    failure_ = std::string(what) + text;
    return Status::fatal;
  }

  /// As above, with the number of the step and what was not finite in it.
  Status fail(const char* what) {
    const Status s = end(what);
    failure_ += ", step " + std::to_string(dynamics_.stats.steps + 1);
    const std::string words = dynamics_.culprit(t_, q(), v());
    if (!words.empty()) failure_ += ": not finite: " + words;
    return s;
  }

  static int rhs(double t, const double* y, double* dydt, void* self_pointer) {
    auto& self = *static_cast<GslOdeiv2*>(self_pointer);
    const In state(y, 2 * self.n_);
    const Out rate(dydt, 2 * self.n_);
    std::copy(state.begin() + static_cast<std::ptrdiff_t>(self.n_), state.end(), dydt);
    return gsl_code(self.dynamics_.accelerate(
        t, state.first(self.n_), state.last(self.n_), rate.last(self.n_), self.lambda_));
  }

  /// Central differences of the acceleration, column by column: bsimp needs the full
  /// dense Jacobian. Its extrapolation in h^2 depends on an accurate one; one-sided
  /// differences (eight digits) stall it at tolerances below 1e-6.
  static int jacobian(double t, const double* y, double* dfdy, double* dfdt,
                      void* pointer) {
    auto& self = *static_cast<GslOdeiv2*>(pointer);
    const std::size_t n = self.n_;
    ++self.dynamics_.stats.linearizations;
    std::fill(dfdy, dfdy + 4 * n * n, 0.0);
    std::fill(dfdt, dfdt + 2 * n, 0.0);
    std::copy(y, y + 2 * n, self.shifted_.begin());
    for (std::size_t j = 0; j < 2 * n; ++j) {
      const double typical =
          j < n ? self.dynamics_.q_typ()[j] : self.dynamics_.v_typ()[j - n];
      const double e = difference * std::max(std::abs(y[j]), typical);
      const Status s = self.difference_of_acceleration(
          [&](double side) {
            self.shifted_[j] = y[j] + side * e;
            return t;
          },
          e);
      self.shifted_[j] = y[j];
      if (s != Status::ok) return gsl_code(s);
      for (std::size_t i = 0; i < n; ++i) dfdy[(n + i) * 2 * n + j] = self.a_[i];
    }
    for (std::size_t i = 0; i < n; ++i) dfdy[i * 2 * n + n + i] = 1;
    const double e = difference * std::max(1.0, std::abs(t));
    const Status s =
        self.difference_of_acceleration([&](double side) { return t + side * e; }, e);
    std::copy(self.a_.begin(), self.a_.end(), dfdt + n);
    return gsl_code(s);
  }

  /// a_ = (a(+1) - a(-1)) / 2e, where move(side) shifts the state and returns the time.
  template <class Move>
  Status difference_of_acceleration(Move move, double e) {
    const In q = In(shifted_).first(n_), v = In(shifted_).last(n_);
    const Status forward = dynamics_.accelerate(move(1), q, v, a_, lambda_);
    if (forward != Status::ok) return forward;
    const Status backward = dynamics_.accelerate(move(-1), q, v, a_shifted_, lambda_);
    for (std::size_t i = 0; i < n_; ++i) a_[i] = (a_[i] - a_shifted_[i]) / (2 * e);
    return backward;
  }

  Options options_;
  Dynamics dynamics_;
  std::size_t n_;
  std::vector<double> y_, shifted_, a_, a_shifted_, lambda_;
  gsl_odeiv2_system ode_;
  std::unique_ptr<gsl_odeiv2_driver, Free> driver_;
  std::optional<Projection> projection_;
  double t_ = 0;
  double h_ = 0;
  std::string failure_;
  Limit limit_ = Limit::none;
};

template <const gsl_odeiv2_step_type** type>
std::unique_ptr<Integrator> make_gsl(System& system, const Options& options) {
  return std::make_unique<GslOdeiv2>(system, options, *type);
}

// A dense Jacobian by differences costs n^2 residual entries per step.
constexpr int most_dense_coordinates = 200;

std::string dense_jacobian(System& system, Formulation formulation) {
  if (system.layout().coordinates > most_dense_coordinates) {
    return "needs a dense Jacobian: at most 200 coordinates";
  }
  return inverts_mass(system, formulation);
}

}  // namespace

IntegratorEntry gsl_rkf45_entry() {
  return {.id = "gsl_rkf45",
          .summary = "explicit Runge-Kutta 5(4)",
          .source = "GSL odeiv2",
          .adaptive = true,
          .formulations = of_order(5, projected_formulations),
          .objection = inverts_mass,
          .make = make_gsl<&gsl_odeiv2_step_rkf45>};
}

IntegratorEntry gsl_rk8pd_entry() {
  return {.id = "gsl_rk8pd",
          .summary = "explicit Runge-Kutta 8(7)",
          .source = "GSL odeiv2",
          .adaptive = true,
          .formulations = of_order(8, projected_formulations),
          .objection = inverts_mass,
          .make = make_gsl<&gsl_odeiv2_step_rk8pd>};
}

IntegratorEntry gsl_msadams_entry() {
  return {.id = "gsl_msadams",
          .summary = "orders 1-12 Adams",
          .source = "GSL odeiv2",
          .adaptive = true,
          .formulations = of_order(12, ode_formulations),
          .gaps = {{Formulation::projection,
                    "a projected state would not match the method's history"}},
          .objection = inverts_mass,
          .make = make_gsl<&gsl_odeiv2_step_msadams>};
}

IntegratorEntry gsl_bsimp_entry() {
  return {.id = "gsl_bsimp",
          .summary = "implicit extrapolation, stiff",
          .source = "GSL odeiv2, Bader-Deuflhard 1983",
          .adaptive = true,
          .formulations = of_order(8, projected_formulations),
          .objection = dense_jacobian,
          .make = make_gsl<&gsl_odeiv2_step_bsimp>};
}

}  // namespace tress::integrators
