#include <gtest/gtest.h>

#include <cstdio>
#include <numbers>

#include "contract/forms/explicit_form.h"
#include "contract/input_error.h"
#include "experiments/numerics/equilibrium.h"
#include "tests/models/reduced/kirchhoff.h"

namespace tress::test_force_transport {

using namespace experiments;

using namespace testing_support;

const ModelSettings curly = {{"natural_curvature_per_m", "60"},
                             {"natural_curvature2_per_m", "10"},
                             {"natural_twist_per_m", "20"},
                             {"ellipticity", "1.3"},
                             {"grading", "2"},
                             {"internal_friction_kg_m3_s", "1e-11"}};

struct Modes {
  const char* word;
  std::size_t dofs;
};
constexpr Modes all_modes[] = {{"bend_twist", 3}, {"bend", 2}, {"bend_planar", 1}};

/// The model and articulated_chain in the same setting.
struct Pair {
  std::unique_ptr<System> transport, chain;
};

Pair pair(const Modes& modes, int elements, const ModelSettings& more = {}) {
  ModelSettings settings = modes.dofs == 1 ? ModelSettings{} : curly;
  settings =
      with(settings, {{"modes", modes.word}, {"elements", std::to_string(elements)}});
  settings = with(settings, more);
  return {make_model("force_transport", settings),
          make_model("articulated_chain", settings)};
}

/// Sums of some hundred terms.
constexpr double rounding = 1e3 * eps;
/// On the condition of a link's 3 x 3 mass matrix: its twist has the section's inertia
/// alone when the link is straight, 1e5 times less than bending.
constexpr double of_accelerations = 1e5 * rounding;

void expect_equal(const std::vector<double>& x, const std::vector<double>& y) {
  ASSERT_GT(largest(y), 0);
  EXPECT_LE(largest(plus(x, -1, y)), rounding * largest(y));
}

// There is nothing beyond the only joint.
TEST(ForceTransport, OfOneSegmentIsTheChain) {
  for (const Modes& modes : all_modes) {
    const Pair models =
        pair(modes, 1, {{"motion", "shake_rotate"}, {"drag_kg_m_s", "1e-6"}});
    States s(*models.chain);
    s.shake(0.5);
    expect_equal(residual(*models.transport, s.q, s.v, s.a),
                 residual(*models.chain, s.q, s.v, s.a));
    std::vector<double> a(s.n), of_chain(s.n);
    ASSERT_EQ(models.transport->explicit_form()->acceleration(t0, s.q, s.v, a),
              Status::ok);
    ASSERT_EQ(models.chain->explicit_form()->acceleration(t0, s.q, s.v, of_chain),
              Status::ok);
    EXPECT_LE(relative_difference(a, of_chain, s.v_typ), of_accelerations);
  }
}

// f of both models is the same: at rest nothing else is left.
TEST(ForceTransport, HasTheForcesOfTheChain) {
  for (const Modes& modes : all_modes) {
    const Pair models =
        pair(modes, 7, {{"motion", "shake_rotate"}, {"drag_kg_m_s", "1e-6"}});
    States s(*models.chain);
    s.shake(0.5);
    const std::vector<double> zero = zeros(*models.chain);
    EXPECT_EQ(residual(*models.transport, s.q, s.v, zero),
              residual(*models.chain, s.q, s.v, zero));
  }
}

// So the cantilever hangs as the chain's, and converges to the gravito-bending curve
// (test_cantilever.cpp): the seed's static error that grows with the number of segments
// is not in these equations. Newton's corrections end at 1e-11.
TEST(ForceTransport, HangsLikeTheChain) {
  const ModelSettings unit_rod = {{"length_m", "1"},
                                  {"radius_m", "0.01"},
                                  {"density_kg_m3", "1000"},
                                  {"youngs_modulus_pa", "127323954.47351627"},
                                  {"poisson_ratio", "0.4"}};
  for (const int n : {5, 10, 20, 40}) {
    const double error = master_error("force_transport", unit_rod, master_curve[1], n);
    const double chain = master_error("articulated_chain", unit_rod, master_curve[1], n);
    std::printf("Gamma = 10, N = %d: H/W off by %.3e, the chain's by %.3e\n", n, error,
                chain);
    EXPECT_NEAR(error, chain, 1e-9);
  }
}

/// What the unit acceleration of unknown j adds to the residual.
std::vector<double> mass_column(System& system, const States& s, std::size_t j) {
  std::vector<double> unit(s.n);
  unit[j] = s.v_typ[j];  // large beside f
  const std::vector<double> zero(s.n);
  return plus(residual(system, s.q, s.v, unit), -1, residual(system, s.q, s.v, zero));
}

// The chain's matrix column by column from its inverse dynamics, which know nothing of
// composite bodies.
TEST(ForceTransport, MassIsTheLowerBlockTriangleOfTheChains) {
  for (const Modes& modes : all_modes) {
    const Pair models = pair(modes, 6, {{"gravity_m_s2", "0"}});
    States s(*models.chain);
    s.shake(0.5);
    std::ranges::fill(s.v, 0.0);
    for (std::size_t j = 0; j < s.n; ++j) {
      const std::vector<double> column = mass_column(*models.transport, s, j);
      const std::vector<double> whole = mass_column(*models.chain, s, j);
      for (std::size_t i = 0; i < s.n; ++i) {
        if (i / modes.dofs < j / modes.dofs) {
          EXPECT_EQ(column[i], 0) << i << ", " << j;
        } else {
          // Forces of bending, taken off again, leave their rounding.
          EXPECT_NEAR(column[i], whole[i],
                      rounding * (largest(whole) +
                                  largest(residual(*models.chain, s.q, s.v, s.v))))
              << i << ", " << j;
        }
      }
    }
  }
}

// Repeated on what is left, a <- a - M_ft^-1 (M a - f) is a block Gauss-Seidel iteration,
// which approaches the chain's acceleration for every positive definite M: the error e
// falls in the norm e^T M e = e^T r with every sweep [Golub, Van Loan, section 11.2].
TEST(ForceTransport, IsTheFirstGaussSeidelSweepOfTheChain) {
  for (const Modes& modes : all_modes) {
    const Pair models = pair(modes, 4, {{"jacobian", "elastic"}});
    States s(*models.chain);
    s.shake(0.5);
    std::vector<double> exact(s.n), a(s.n), step(s.n);
    ASSERT_EQ(models.chain->explicit_form()->acceleration(t0, s.q, s.v, exact),
              Status::ok);
    std::vector<double> first(s.n);
    ASSERT_EQ(models.transport->explicit_form()->acceleration(t0, s.q, s.v, first),
              Status::ok);
    ASSERT_EQ(models.transport->linearize(t0, s.q, s.v, s.a, {1, 0, 0}), Status::ok);
    double before = std::numeric_limits<double>::infinity();
    for (int sweep = 0; sweep < 20; ++sweep) {
      const std::vector<double> r = residual(*models.chain, s.q, s.v, a);
      double norm = 0;
      for (std::size_t i = 0; i < s.n; ++i) norm += (a[i] - exact[i]) * r[i];
      EXPECT_LT(norm, before) << modes.word << ", sweep " << sweep;
      before = norm;
      ASSERT_EQ(models.transport->solve(r, step), Status::ok);
      a = plus(a, -1, step);
      if (sweep > 0) continue;
      EXPECT_LE(relative_difference(a, first, s.v_typ), of_accelerations);
    }
  }
}

// The contract's Jacobian test sees strands that are nearly straight; these are coiled,
// of unequal segments, in drag, on a root that turns. Errors of 0 are below rounding.
TEST(ForceTransport, TangentIsExactOnCurls) {
  for (const Modes& modes : all_modes) {
    const ModelSettings setting = {{"motion", "shake_rotate"}, {"drag_kg_m_s", "1e-6"}};
    const Pair models = pair(modes, 6, setting);
    const Pair stiff = pair(modes, 6, with(setting, {{"jacobian", "elastic"}}));
    double most = 0, without = std::numeric_limits<double>::infinity();
    for (const Weights w : {Weights{1, 1e-3, 1e-6}, Weights{1, 0.1, 0.01},
                            Weights{1, 0, 0}, Weights{0, 0, 1}, Weights{400, 20, 1}}) {
      States s(*models.transport, 5);
      s.shake(0.5);
      most = std::max(most, tangent_error(*models.transport, *models.transport, s, w));
      if (w.vel < 0.1) continue;
      without =
          std::min(without, tangent_error(*stiff.transport, *models.transport, s, w));
    }
    std::printf("%s: tangent off by %.1e, the stiff one by %.1e\n", modes.word, most,
                without);
    EXPECT_LE(most, tangent_tolerance);
    EXPECT_GT(without, 1e-3);
  }
}

// K of a straight strand is block diagonal and M_ft block lower triangular, so the
// eigenvalues of K x = omega^2 M_ft x are those of the diagonal blocks: in the plane
// K_j / M_jj, real and positive. With K = EI/l, twice that at the clamp, and M_jj =
// rho S (L - s_j)^3/3 the smallest is, over EI/(rho S L^4), that of the second joint, 3 N
// / (1 - 1/N)^3, or 6 N of the clamp: for N < 5.
TEST(ForceTransport, FirstFrequencyGrowsWithTheNumberOfSegments) {
  constexpr double beam = 3.5160152685001512;  // Euler and Bernoulli's
  for (const int n : {1, 2, 3, 4, 5, 10, 20, 40, 80}) {
    const Pair models = pair(all_modes[2], n, {{"gravity_m_s2", "0"}});
    const Parameters p = parameters_of("force_transport", {});
    const double length = p.number("length_m"), radius = p.number("radius_m");
    const double unit = p.number("youngs_modulus_pa") * radius * radius /
                        (4 * p.number("density_kg_m3") * std::pow(length, 4));
    const std::vector<double> zero = zeros(*models.transport);
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < zero.size(); ++j) {
      std::vector<double> e = zero;
      e[j] = 1;
      const double k = residual(*models.transport, e, zero, zero)[j];
      const double m = residual(*models.transport, zero, zero, e)[j];
      EXPECT_GT(k, 0);
      EXPECT_GT(m, 0);
      least = std::min(least, k / m / unit);
    }
    const double rest = 1 - 1.0 / n;
    const double expected = std::min(6.0 * n, n > 1 ? 3 * n / (rest * rest * rest) : 6.0);
    std::printf("N = %d: first frequency %.4f, %.3f of the rod's\n", n, std::sqrt(least),
                std::sqrt(least) / beam);
    EXPECT_NEAR(least / expected, 1, rounding);
  }
}

// Two links of mass m and length l hanging from joints without springs have, in joint
// angles, K = m g l [2 1/2; 1/2 1/2] and M_ft = m l^2 [8/3 0; 5/6 1/3]. The eigenvalues
// of M_ft^-1 K, with trace 57/32 and determinant 27/32 in g/l, are complex: the
// oscillation grows, whatever the step.
TEST(ForceTransport, OfTwoHangingLinksFlutters) {
  const ModelSettings hanging = {{"root_tangent", "down"}, {"youngs_modulus_pa", "1"}};
  const Pair models = pair(all_modes[2], 2, hanging);
  const Parameters p = parameters_of("force_transport", hanging);
  const double unit = p.number("gravity_m_s2") / (p.number("length_m") / 2);
  const double real = 57.0 / 64, square = 27.0 / 32;
  const double size = std::sqrt(square);
  const std::vector<double> rest = zeros(*models.transport);
  const LinearModes modes = linear_modes(*models.transport, rest);
  EXPECT_EQ(modes.complex_modes, 2);
  // Springs of EI/l = 3e-10 m g l; differences leave 1e-10 of K, thirty times that of
  // the small difference of size and real.
  EXPECT_NEAR(modes.slowest_rad_s / std::sqrt(size * unit), 1, 1e-7);
  EXPECT_NEAR(modes.growth_per_s / std::sqrt((size - real) / 2 * unit), 1, 1e-7);
  EXPECT_EQ(linear_modes(*models.chain, rest).growth_per_s, 0);
}

TEST(ForceTransport, OfStiffHangingStrandsFluttersToo) {
  for (const char* modulus : {"1e6", "3e9"}) {
    for (const int n : {5, 10, 20, 40}) {
      const Pair models = pair(
          all_modes[2], n, {{"root_tangent", "down"}, {"youngs_modulus_pa", modulus}});
      const std::vector<double> rest = zeros(*models.transport);
      const LinearModes modes = linear_modes(*models.transport, rest);
      std::printf("E = %s Pa, N = %d: grows at %.2f 1/s, %d of %d complex\n", modulus, n,
                  modes.growth_per_s, modes.complex_modes, n);
      EXPECT_GT(modes.growth_per_s, 1);
      EXPECT_EQ(linear_modes(*models.chain, rest).growth_per_s, 0);
    }
  }
}

// As in test_solvers.cpp: rounding on a condition of up to 1e5 from steps of 0.1 ms on.
TEST(ForceTransport, SweepSolvesTheDenseMatrix) {
  for (const Modes& modes : all_modes) {
    const ModelSettings stiff = {{"jacobian", "elastic"}, {"motion", "shake_rotate"}};
    const Pair sweep = pair(modes, 20, stiff);
    const Pair dense = pair(modes, 20, with(stiff, {{"solver", "composite"}}));
    for (const double h : {1e-4, 1e-3, 1e-2, 1e-1}) {
      States s(*sweep.transport);
      s.shake(0.5);
      const std::vector<double> b = residual(*sweep.transport, s.q, s.v, s.a);
      std::vector<double> x(s.n), y(s.n);
      for (auto& [system, to] :
           {std::pair{sweep.transport.get(), &x}, std::pair{dense.transport.get(), &y}}) {
        ASSERT_EQ(system->linearize(t0, s.q, s.v, s.a, {1, h, h * h}), Status::ok);
        ASSERT_EQ(system->solve(b, *to), Status::ok);
      }
      EXPECT_LE(relative_difference(x, y, s.a_typ), 1e-10) << modes.word << ", " << h;
    }
  }
}

TEST(ForceTransport, RefusesAFreeRoot) {
  EXPECT_THROW(make_model("force_transport", {{"motion", "free"}}), InputError);
}

}  // namespace tress::test_force_transport
