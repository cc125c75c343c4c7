#include <gtest/gtest.h>

#include <cstdio>
#include <numbers>

#include "contract/input_error.h"
#include "experiments/numerics/fit.h"
#include "integrators/integrator_options.h"
#include "tests/support/apart.h"
#include "tests/support/compliant.h"

namespace tress::test_xpbd {

using namespace experiments;

using namespace testing_support;

constexpr double step = 0.1;
constexpr double spring = 300, friction = 2;  // N/m, N s/m: stiff, (h omega)^2 = 3

Options sweeps(int count, std::string_view order = "root_to_tip") {
  Options options;
  options.step = step;
  apply(options, "sweeps", std::to_string(count), "test");
  apply(options, "sweep_order", order, "test");
  options.newton_tolerance = 1e-13;
  return options;
}

// Friction and all: eqs. 18 and 26 are the rows of backward Euler's equations.
TEST(Xpbd, ConvergedSweepsAreBackwardEulerOfALinearSystem) {
  for (const int masses : {2, 3, 8, 9}) {
    MassLine line(masses, spring, friction);
    const auto exact = at_end("backward_euler", line, sweeps(1), 5 * step);
    for (const auto order : {"root_to_tip", "bilateral"}) {
      // Rates below are under 0.75: 0.75^200 is rounding. 1e-13 is Newton's tolerance,
      // carried through five steps.
      EXPECT_LE(apart(at_end("xpbd", line, sweeps(200, order), 5 * step), exact), 1e-12);
    }
  }
  // One block needs one sweep.
  MassLine pair(2, spring, friction);
  EXPECT_LE(apart(at_end("xpbd", pair, sweeps(1), 5 * step),
                  at_end("backward_euler", pair, sweeps(1), 5 * step)),
            1e-12);
}

// The multipliers solve (G W G^T + alpha/h^2) lambda = -C, tridiagonal: 2 w + alpha/h^2
// and -w. Gauss-Seidel is the square of Jacobi (consistently ordered matrices [Young
// 1971]), whose rate is 2 w cos(pi/n)/(2 w + alpha/h^2). Rates go to 1 as h^2 k grows and
// as 1 - (pi/n)^2 as n does: what is missing after a number of sweeps is what makes
// position-based strands soft.
TEST(Xpbd, SweepsConvergeAtTheRateOfGaussSeidel) {
  int seen = 0;
  for (const int masses : {5, 10, 20}) {
    for (const double k : {30.0, 300.0, 3e6}) {
      MassLine line(masses, k, 0);
      Options converged = sweeps(1);
      const auto exact = at_end("backward_euler", line, converged, step);
      const double angle = std::numbers::pi / masses;
      const double jacobi = 2 * std::cos(angle) / (2 + 1 / (k * step * step));
      const double rate = jacobi * jacobi;
      for (const auto order : {"root_to_tip", "bilateral"}) {
        // The slowest mode but one falls by 1e-5 beside the slowest, which leaves it a
        // hundredth whatever the start was within a factor of 1000; where both are at
        // rounding by then there is nothing to see.
        const double beside = std::pow(std::cos(2 * angle) / std::cos(angle), 2);
        const int many = static_cast<int>(std::ceil(std::log(1e-5) / std::log(beside)));
        if (std::pow(rate, many) < 1e-7) continue;
        ++seen;
        const double before =
            apart(at_end("xpbd", line, sweeps(many, order), step), exact);
        const double after =
            apart(at_end("xpbd", line, sweeps(many + 1, order), step), exact);
        EXPECT_NEAR(after / before, rate, 0.01 * rate)
            << masses << " masses, k = " << k << ", " << many << " sweeps";
      }
    }
  }
  EXPECT_EQ(seen, 12);  // in two orders: 5 masses at all k, 10 at two, 20 at the stiffest
}

// Backward Euler on a convex energy: its step is the least of
// |x - q - h v|^2/(2 h^2) + E(x), so that kinetic and elastic energy fall.
TEST(Xpbd, ConvergedSweepsLoseEnergyInEveryStep) {
  MassLine line(9, spring, 0);
  Drive drive("xpbd", line, sweeps(200));
  double last = line.energetics()->energy(0, drive.q0, drive.v0).total();
  const double start = last;
  EXPECT_EQ(drive.to(20 * step,
                     [&](double t, In q, In v) {
                       const double now = line.energetics()->energy(t, q, v).total();
                       EXPECT_LE(now, last + 1e-12 * start);
                       last = now;
                       return true;
                     }),
            Status::ok);
  EXPECT_LT(last, 0.5 * start);
}

// What remains is the change of G on the way from the prediction, off by h^2 a, to the
// end of the step: h^2 of the force's size, and so of the motion, where backward Euler
// itself is off by h.
TEST(Xpbd, ConvergedSweepsDifferFromBackwardEulerByOrder2) {
  for (const std::string_view model : {"xpbd_cosserat", "corde", "mass_spring"}) {
    const auto system = soft_strand(model);
    std::vector<double> steps, errors;
    for (const double h : {2e-4, 1e-4, 5e-5}) {
      Options options = sweeps(100);
      options.step = h;
      steps.push_back(h);
      errors.push_back(apart(at_end("xpbd", *system, options, 0.02),
                             at_end("backward_euler", *system, options, 0.02)));
      std::printf("%s, step %g s: %.2e from backward_euler\n", std::string(model).c_str(),
                  h, errors.back());
    }
    EXPECT_NEAR(log_log_slope(steps, errors), 2, 0.1) << model;
  }
}

// The rows of BDF2's equations, and of backward Euler's in the first step.
TEST(XpbdBdf2, ConvergedSweepsAreBdf2OfALinearSystem) {
  for (const int masses : {2, 3, 8, 9}) {
    MassLine line(masses, spring, friction);
    const auto exact = at_end("bdf2", line, sweeps(1), 5 * step);
    for (const auto order : {"root_to_tip", "bilateral"}) {
      EXPECT_LE(apart(at_end("xpbd_bdf2", line, sweeps(200, order), 5 * step), exact),
                1e-12);
    }
    // The coefficients know a last step that is shorter.
    EXPECT_LE(apart(at_end("xpbd_bdf2", line, sweeps(200), 5.4 * step),
                    at_end("bdf2", line, sweeps(1), 5.4 * step)),
              1e-12);
  }
}

// As above for the change of G and for what is extrapolated: order 2 of the difference
// from bdf2, whose own is 2.
TEST(XpbdBdf2, ConvergedSweepsHaveOrder2OnStrands) {
  for (const std::string_view model : {"xpbd_cosserat", "corde", "mass_spring"}) {
    const auto system = soft_strand(model);
    Options fine = sweeps(1);
    fine.step = 1e-5;
    const auto exact = at_end("bdf2", *system, fine, 0.02);
    std::vector<double> steps, errors;
    for (const double h : {2e-4, 1e-4, 5e-5}) {
      Options options = sweeps(100);
      options.step = h;
      steps.push_back(h);
      errors.push_back(apart(at_end("xpbd_bdf2", *system, options, 0.02), exact));
      std::printf("%s, step %g s: %.2e\n", std::string(model).c_str(), h, errors.back());
    }
    EXPECT_NEAR(log_log_slope(steps, errors), 2, 0.2) << model;
    Options first_order = sweeps(100);
    first_order.step = 5e-5;
    EXPECT_LT(5 * errors.back(),
              apart(at_end("xpbd", *system, first_order, 0.02), exact));
  }
}

// One sweep over a stiff line is far from settled: every step is xpbd's own, to the bit.
TEST(XpbdBdf2, StepsThatHaveNotSettledAreXpbds) {
  MassLine line(20, 3e6, 0);
  EXPECT_EQ(at_end("xpbd_bdf2", line, sweeps(1), 5 * step),
            at_end("xpbd", line, sweeps(1), 5 * step));
  MassLine soft(20, 0.3, 0);
  EXPECT_GT(apart(at_end("xpbd_bdf2", soft, sweeps(8), 5 * step),
                  at_end("xpbd", soft, sweeps(8), 5 * step)),
            1e-3);
}

TEST(Xpbd, IsRefusedWhereThereAreNoCompliances) {
  const IntegratorEntry& xpbd = find_integrator("xpbd");
  for (const char* model : {"super_helix", "der", "dynamic_spline", "bead_on_wire"}) {
    const auto system = make_model(model);
    const bool constrained = system->layout().constraints > 0;
    const std::string why = refusal(
        xpbd, *system, constrained ? Formulation::index3 : Formulation::parametric);
    EXPECT_EQ(why, constrained ? "takes energies, not constraints with multipliers"
                               : "needs the model's energy as compliant constraints")
        << model;
  }
  const auto system = make_model("super_helix");
  EXPECT_THROW(make_integrator("xpbd", *system, {}), InputError);
  EXPECT_EQ(refusal(xpbd, *make_model("xpbd_cosserat"), Formulation::parametric), "");
}

}  // namespace tress::test_xpbd
