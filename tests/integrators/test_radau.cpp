#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <string_view>
#include <utility>

#include "experiments/problems/formulations.h"
#include "experiments/problems/strand_models.h"
#include "experiments/problems/strand_scenes.h"
#include "integrators/one_step/radau.h"
#include "tests/support/double_pendulum.h"
#include "tests/support/drive.h"

namespace tress::test_radau {

using namespace experiments;
using namespace integrators;

constexpr std::size_t n = RadauTable::stages;
using Complex = std::complex<double>;
using Matrix = std::array<std::array<Complex, n>, n>;

// The conditions B(5) and C(3) determine the method. [Hairer, Wanner 1996, Solving ODEs
// II, section IV.5]
TEST(Radau, SatisfiesTheSimplifyingConditions) {
  const RadauTable& table = radau_table();
  constexpr double rounding = 1e-15;
  for (int k = 1; k <= 5; ++k) {
    for (std::size_t i = 0; i < n; ++i) {
      if (k > 3 && i + 1 < n) continue;  // the last row has the weights
      double sum = 0;
      for (std::size_t j = 0; j < n; ++j) {
        sum += table.a[i][j] * std::pow(table.c[j], k - 1);
      }
      EXPECT_NEAR(sum, std::pow(table.c[i], k) / k, rounding) << i << ", " << k;
    }
  }
}

Matrix product(const Matrix& x, const Matrix& y) {
  Matrix p{};
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < n; ++k) {
      for (std::size_t j = 0; j < n; ++j) p[i][j] += x[i][k] * y[k][j];
    }
  }
  return p;
}

/// (I - z T)^-1 z (A - T)
Matrix iteration(Complex z) {
  const RadauTable& table = radau_table();
  Matrix m{};
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t i = 0; i < n; ++i) {
      Complex sum = z * (table.a[i][j] - table.t[i][j]);
      for (std::size_t k = 0; k < i; ++k) sum += z * table.t[i][k] * m[k][j];
      m[i][j] = sum / (1. - z * table.t[i][i]);
    }
  }
  return m;
}

/// The spectral radius, as the 64th root of the norm of the 64th power: too large by
/// 3^(1/64) and by what is not diagonal at most.
double spectral_radius(Matrix m) {
  double scale = 1, power = 1;
  for (int squarings = 0; squarings < 6; ++squarings) {
    m = product(m, m);
    power *= 2;
    double largest = 0;
    for (const auto& row : m) {
      for (const Complex& entry : row) largest = std::max(largest, std::abs(entry));
    }
    scale *= std::pow(largest, 1 / power);
    for (auto& row : m) {
      for (Complex& entry : row) entry /= largest;
    }
  }
  return scale;
}

TEST(Radau, IteratesAtARateOfAQuarterInTheLeftHalfPlane) {
  double worst = 0;
  for (double size = 1e-2; size < 1e5; size *= 1.2) {
    for (double angle = M_PI / 2; angle < 3.2; angle += M_PI / 16) {
      worst = std::max(worst, spectral_radius(iteration(std::polar(size, angle))));
    }
  }
  EXPECT_LE(worst, 0.25);
  EXPECT_GE(worst, 0.2);  // the search sees the worst place
}

TEST(Radau, KeepsItsOrderWithAVariableMass) {
  Options options;
  options.refresh = Refresh::every_step;
  options.newton_tolerance = 1e-13;
  EXPECT_LE(testing_support::expect_order_on_double_pendulum("radau5", options,
                                                             {50, 100, 200, 400}, 4.75),
            1e-10);
}

/// Steps, s.
constexpr double steps[] = {1 / 30., 1e-2, 1 / 300., 1e-3};

/// Scenes, with the longest step (s) at which both methods are compared. At 1/30 s,
/// radau5 finds no solution of whip or curl_drop on some models with stretch. Without the
/// whole Jacobian of the stages it finds none of one of these scenes or more on 8 of
/// the models.
constexpr std::pair<std::string_view, double> scenes[] = {
    {"release", 1 / 30.}, {"swing", 1 / 30.}, {"whip", 1e-2}, {"curl_drop", 1e-2}};

class RadauOnStrands : public testing::TestWithParam<const ModelEntry*> {};

Status run_to_the_end(std::string_view id, const ModelEntry& model,
                      std::string_view scene, double step) {
  Parameters p(setup_parameters(model), "model");
  set_known(p, find_strand_scene(scene).settings);
  set_known(p, {{"modes", "bend"}, {"elements", "10"}});
  const auto system = model.make(p);
  Options options;
  options.step = step;
  options.refresh = Refresh::every_step;
  options.newton_tolerance = 1e-6;
  options.formulation = *preferred_formulation(find_integrator(id), *system);
  testing_support::Drive drive(id, *system, options);
  return drive.to(0.1);
}

TEST_P(RadauOnStrands, FindsASolutionWhereverEsdirk43Does) {
  const ModelEntry& model = *GetParam();
  const bool dense = model.id == "dynamic_spline";  // minutes with the whole Jacobian
  int compared = 0;
  for (const auto& [scene, longest] : scenes) {
    for (const double step : steps) {
      if (step > (dense ? std::min(longest, 1e-2) : longest)) continue;
      if (run_to_the_end("esdirk43", model, scene, step) != Status::ok) continue;
      ++compared;
      EXPECT_EQ(run_to_the_end("radau5", model, scene, step), Status::ok)
          << scene << ", " << step << " s";
    }
  }
  EXPECT_GE(compared, 4);
}

INSTANTIATE_TEST_SUITE_P(Models, RadauOnStrands, testing::ValuesIn(strand_models()),
                         [](const auto& test) { return std::string(test.param->id); });

}  // namespace tress::test_radau
