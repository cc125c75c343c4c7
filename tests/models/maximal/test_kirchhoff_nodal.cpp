#include <gtest/gtest.h>

#include <cstdio>

#include "contract/forms/explicit_form.h"
#include "contract/input_error.h"
#include "experiments/numerics/dense_algebra.h"
#include "experiments/numerics/fit.h"
#include "models/catalogue.h"
#include "tests/models/maximal/clamped_modes.h"
#include "tests/models/maximal/thin_rod.h"
#include "tests/models/reduced/kirchhoff.h"

namespace tress::test_kirchhoff_nodal {

using namespace experiments;

using namespace testing_support;

const ModelSettings unit_rod = {{"length_m", "1"},
                                {"radius_m", "0.01"},
                                {"density_kg_m3", "1000"},
                                {"youngs_modulus_pa", "127323954.47351627"},
                                {"poisson_ratio", "0.4"}};

/// Accelerations are fourth differences of curvatures: rounding eps is n^4 eps of the
/// leading term, and rests off by that over (beta L)^4 = 12 of the slowest mode.
double at_rest(int n) { return std::max(1e-11, eps * std::pow(n, 4) / 12); }

TEST(KirchhoffNodal, CantileverApproachesTheGravitoBendingCurveAtOrder2) {
  for (const Master& exact : master_curve) {
    std::vector<double> sizes, errors;
    for (const int n : {20, 40, 80, 160}) {
      sizes.push_back(1.0 / n);
      errors.push_back(master_error("kirchhoff_nodal", unit_rod, exact, n, at_rest(n)));
      std::printf("kirchhoff_nodal, Gamma = %g, N = %d: H/W off by %.2e\n", exact.gamma,
                  n, errors.back());
    }
    EXPECT_LE(errors[1], 0.01);
    // Lumping makes the tip hang too low, 2 tan(angle/2) too high; where h^2 of both
    // nearly cancel, at Gamma >= 10, the ends' h^3 is a tenth of the rest at N = 80: the
    // errors over h^2 go to a limit, and what they lack of it halves with h, up to (kappa
    // h)^2 = 2 Gamma h^2, 0.12 at N = 40 and Gamma = 100.
    const auto limit = [&](std::size_t i) { return errors[i] / (sizes[i] * sizes[i]); };
    const double order = std::log2(errors[2] / errors[3]);
    EXPECT_NEAR(order, 2, exact.gamma > 1 ? 0.2 : 0.01) << exact.gamma;
    if (exact.gamma > 1) {
      EXPECT_NEAR((limit(3) - limit(2)) / (limit(2) - limit(1)), 0.5, 0.12);
    }
  }
}

TEST(KirchhoffNodal, CurlyHairApproachesKirchhoffsRodAtOrder2) {
  std::vector<double> sizes, away, energy_off;
  for (const std::size_t n : {12U, 24U, 48U, 84U}) {
    const CurlyError error =
        curly_error("kirchhoff_nodal", unit_rod, n, at_rest(static_cast<int>(n)));
    sizes.push_back(1.0 / static_cast<double>(n));
    away.push_back(error.points);
    energy_off.push_back(error.energy);
    std::printf("kirchhoff_nodal, N = %zu: points off by %.2e L, energy by %.2e\n", n,
                away.back(), energy_off.back());
  }
  EXPECT_LE(away.back(), 5e-3);
  // As of the other strands, see tests/models/reduced/test_cantilever.cpp.
  const auto order = [&](const std::vector<double>& errors) {
    return log_log_slope({sizes.begin() + 1, sizes.end()},
                         {errors.begin() + 1, errors.end()});
  };
  EXPECT_NEAR(order(away), 2, 0.1);
  EXPECT_NEAR(order(energy_off), 2, 0.1);
}

/// 1/omega^2 of the bending modes of a straight strand about e1, descending: S(0, 0, 1)
/// is then diag(1/d) times a symmetric matrix times diag(EI), d of the joints, half at
/// the clamp.
std::vector<double> squared_periods(int n) {
  const auto system = make_model(
      "kirchhoff_nodal",
      with(unit_rod, {{"gravity_m_s2", "0"}, {"elements", std::to_string(n)}}));
  const std::vector<double> zero = zeros(*system);
  EXPECT_EQ(system->linearize(0, zero, zero, zero, {0, 0, 1}), Status::ok);
  const auto weight = [](int joint) { return joint == 0 ? std::sqrt(0.5) : 1; };
  Eigen::MatrixXd inverse(n, n);
  for (int j = 0; j < n; ++j) {
    std::vector<double> x = zero;
    x[3 * static_cast<std::size_t>(j) + 1] = 1;
    EXPECT_EQ(system->solve(x, x), Status::ok);
    for (int i = 0; i < n; ++i) {
      inverse(i, j) = weight(i) * x[3 * static_cast<std::size_t>(i) + 1] / weight(j);
    }
  }
  EXPECT_LE((inverse - inverse.transpose()).norm(), 1e-8 * inverse.norm());
  const Eigen::VectorXd ascending =
      symmetric_eigenvalues((inverse + inverse.transpose()) / 2);
  return {ascending.data(), ascending.data() + n};
}

TEST(KirchhoffNodal, ClampedFrequenciesApproachTheBeamAtOrder2) {
  std::vector<double> sizes, errors;
  for (const int n : {10, 20, 40}) {
    const std::vector<double> squares = squared_periods(n);
    double worst = 0;
    for (std::size_t mode = 0; mode < 3; ++mode) {
      const double square = squares[squares.size() - 1 - mode];
      const double off = std::sqrt(line_density / square) / beam[mode] - 1;
      worst = std::max(worst, std::abs(off));
      std::printf("kirchhoff_nodal, N = %d, mode %zu: off by %.2e\n", n, mode + 1, off);
    }
    // The highest is that of the fourth difference, omega = 4 sqrt(EI/(rho S))/h^2, but
    // for the ends: (pi/N)^2 of it.
    const double highest = std::sqrt(line_density / squares.front()) / (4.0 * n * n);
    EXPECT_NEAR(highest, 1, std::pow(3.2 / n, 2)) << n;
    sizes.push_back(1.0 / n);
    errors.push_back(worst);
  }
  EXPECT_LE(errors.back(), 0.01);
  EXPECT_NEAR(log_log_slope(sizes, errors), 2, 0.1);
}

const ModelSettings everything = {{"elements", "9"},
                                  {"motion", "shake_rotate"},
                                  {"natural_curvature_per_m", "60"},
                                  {"natural_curvature2_per_m", "-20"},
                                  {"natural_twist_per_m", "30"},
                                  {"ellipticity", "1.5"},
                                  {"internal_friction_kg_m3_s", "1e-11"},
                                  {"drag_kg_m_s", "1e-5"},
                                  {"mass_damping_per_s", "3"}};

TEST(KirchhoffNodal, TangentHoldsCurlsFrictionDragAndTheClamp) {
  const auto system = make_model("kirchhoff_nodal", everything);
  States s(*system);
  for (const Weights w : {Weights{1, 0.1, 0.01}, Weights{400, 20, 1}, Weights{1, 1, 0}}) {
    s.shake(0.5);
    EXPECT_LE(tangent_error(*system, *system, s, w), tangent_tolerance);
  }
}

// With every term alive: what the energy gains is what the power says, to the
// differences' own error (see EnergyChangesByThePowerOfTheRemainingForces).
TEST(KirchhoffNodal, TheGridKeepsTheBalanceOfEnergy) {
  const auto system = make_model("kirchhoff_nodal", everything);
  Energetics& energetics = *system->energetics();
  States s(*system);
  s.shake(0.5);
  std::vector<double> a(s.n);
  ASSERT_EQ(system->explicit_form()->acceleration(t0, s.q, s.v, a), Status::ok);
  const double time = std::min(s.q_typ[0] / largest(s.v), largest(s.v) / largest(a));
  const double rate = central_difference(difference_step * time, [&](double e) {
    const auto q = plus(plus(s.q, e, s.v), e * e / 2, a);
    return std::vector<double>{energetics.energy(t0 + e, q, plus(s.v, e, a)).total()};
  })[0];
  const Energy now = energetics.energy(t0, s.q, s.v);
  const double scale = std::abs(now.kinetic) + std::abs(now.potential);
  EXPECT_NEAR(rate, energetics.power(t0, s.q, s.v), 1e-10 * scale / time);
}

/// S(w) x of the exact Jacobian where the strand starts.
std::vector<double> exact_times(const ModelSettings& settings, Weights w,
                                const std::vector<double>& x) {
  const auto system = make_model("kirchhoff_nodal", settings);
  return tangent_product(*system, States(*system), w, x);
}

/// The shortest wave of the grid of twist (0) or a curvature (1, 2).
std::vector<double> shortest_wave(int n, std::size_t component) {
  std::vector<double> wave(3 * static_cast<std::size_t>(n));
  for (std::size_t j = 0; 3 * j < wave.size(); ++j) {
    wave[3 * j + component] = j % 2 == 0 ? 1 : -1;
  }
  return wave;
}

const ModelSettings weightless = with(thin_rod, {{"gravity_m_s2", "0"}});

TEST(KirchhoffNodal, StiffTangentIsThatOfTheStraightStrand) {
  // gamma/EI = 0.01 s
  const ModelSettings straight =
      with(weightless, {{"ellipticity", "1.5"}, {"internal_friction_kg_m3_s", "0.01"}});
  const auto stiff =
      make_model("kirchhoff_nodal", with(straight, {{"jacobian", "elastic"}}));
  const std::vector<double> zero = zeros(*stiff);
  const int n = static_cast<int>(zero.size()) / 3;
  for (const Weights w : {Weights{0, 0, 1}, Weights{0, 1, 0}, Weights{1, 0.1, 0.01}}) {
    EXPECT_EQ(stiff->linearize(0, zero, zero, zero, w), Status::ok);
    for (const std::size_t component : {0U, 1U, 2U}) {
      const std::vector<double> wave = shortest_wave(n, component);
      std::vector<double> x = exact_times(straight, w, wave);
      EXPECT_EQ(stiff->solve(x, x), Status::ok);
      // That of the differences times the condition n^4.
      EXPECT_LE(largest(plus(x, -1, wave)), 1e-13 * std::pow(n, 4)) << component;
    }
  }
}

// On a strand of curvature kappa = 1/L the next terms are kappa/k of the leading ones,
// kappa h/2 for the shortest waves, k = 2/h.
TEST(KirchhoffNodal, StiffTangentHoldsTheTermsOfHighestOrder) {
  const ModelSettings bent =
      with(weightless, {{"initial", "bent"}, {"initial_curvature_per_m", "1"}});
  std::vector<double> sizes, left_out[3];
  for (const int n : {20, 40, 80}) {
    const ModelSettings elements = {{"elements", std::to_string(n)}};
    sizes.push_back(1.0 / n);
    for (const std::size_t component : {0U, 1U, 2U}) {
      const std::vector<double> wave = shortest_wave(n, component);
      const auto highest = exact_times(with(weightless, elements), {0, 0, 1}, wave);
      const auto whole = exact_times(with(bent, elements), {0, 0, 1}, wave);
      left_out[component].push_back(largest(plus(whole, -1, highest)) / largest(highest));
      std::printf("N = %d, component %zu: left out %.2e\n", n, component,
                  left_out[component].back());
      EXPECT_LE(left_out[component].back(), 0.5 / n);
    }
  }
  for (const auto& part : left_out) EXPECT_NEAR(log_log_slope(sizes, part), 1, 0.1);
}

/// The tip 0.1 s after a hair was released.
Vec released_tip(std::string_view model, int n, const ModelSettings& more,
                 std::string_view integrator, double step) {
  const auto system = make_model(model, with(more, {{"elements", std::to_string(n)}}));
  const State start = initial_state(*system);
  Options options;
  options.step = step;
  if (system->layout().constraints > 0) options.formulation = Formulation::projection;
  const Simulation run = simulate(integrator, *system, options, start, 0.1);
  EXPECT_EQ(run.status, Status::ok) << run.failure;
  MaterialPoints& at = *system->material_points();
  std::vector<double> x(3 * static_cast<std::size_t>(at.count()));
  at.positions(0.1, run.state.q, x);
  return load3(&x[x.size() - 3]);
}

TEST(KirchhoffNodal, FallsAsHelicesDo) {
  const ModelSettings hair = {{"natural_curvature_per_m", "20"},
                              {"natural_twist_per_m", "20"}};
  const auto helices = [&](int n) {
    return released_tip("super_helix", n, hair, "implicit_midpoint", 1e-4);
  };
  const Vec fine = helices(40), reference = fine + (1.0 / 3) * (fine - helices(20));
  std::vector<double> sizes, errors;
  for (const int n : {10, 20, 40}) {
    const Vec tip =
        released_tip("kirchhoff_nodal", n, hair, "linearly_implicit_midpoint", 2e-4);
    const Vec apart = tip - reference;
    sizes.push_back(1.0 / n);
    errors.push_back(norm(apart) / 0.1);
    std::printf("kirchhoff_nodal, N = %d: tip off by %.2e L after 0.1 s\n", n,
                errors.back());
  }
  EXPECT_GE(log_log_slope(sizes, errors), 2 - 0.1);
}

// In a plane the grid is that of der without stretch, in other coordinates.
TEST(KirchhoffNodal, FallsInThePlaneAsDerDoesOnTheSameGrid) {
  const ModelSettings hair = {{"natural_curvature_per_m", "20"}};
  std::vector<double> steps, errors;
  for (const double step : {4e-4, 2e-4, 1e-4}) {
    const Vec der = released_tip("der", 10, with(hair, {{"stretch", "inextensible"}}),
                                 "generalized_alpha", step);
    const Vec apart =
        released_tip("kirchhoff_nodal", 10, hair, "generalized_alpha", step) - der;
    steps.push_back(step);
    errors.push_back(norm(apart) / 0.1);
    std::printf("kirchhoff_nodal, step %g s: tip off der's by %.2e L\n", step,
                errors.back());
  }
  EXPECT_NEAR(log_log_slope(steps, errors), 2, 0.1);
}

TEST(KirchhoffNodal, RefusesWhatIsNoClampedChain) {
  EXPECT_THROW((void)make_model("kirchhoff_nodal", {{"motion", "free"}}), InputError);
  const Parameters p = parameters_of("super_helix", {{"motion", "free"}});
  const auto make = [](const Strand& one) {
    return find_model("kirchhoff_nodal")
        .on_strand(one, parameters_of("kirchhoff_nodal", {}), {});
  };
  EXPECT_THROW((void)make(strand(p)), InputError);
  Strand branched = strand(parameters_of("super_helix", {{"elements", "3"}}));
  branched.segments[2].parent = 0;
  EXPECT_THROW((void)make(branched), InputError);
}

}  // namespace tress::test_kirchhoff_nodal
