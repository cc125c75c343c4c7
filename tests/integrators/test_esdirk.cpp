#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include "experiments/numerics/fit.h"
#include "integrators/esdirk43.h"
#include "integrators/tr_bdf2.h"
#include "models/catalogue.h"
#include "tests/support/drive.h"

namespace tress::test_esdirk {

using namespace experiments;
using testing_support::Drive;

struct Named {
  std::string id;
  const EsdirkTable* table;
};
void PrintTo(const Named& method, std::ostream* out) { *out << method.id; }  // NOLINT

const Named all_methods[] = {{"tr_bdf2", &tr_bdf2_table()},
                             {"esdirk43", &esdirk43_table()}};

using Column = std::vector<double>;

Column times(const EsdirkTable& table) {
  Column c;
  for (std::size_t i = 0; i < table.stages; ++i) c.push_back(table.c(i));
  return c;
}

/// A x
Column times_a(const EsdirkTable& table, const Column& x) {
  Column product(table.stages);
  for (std::size_t i = 0; i < table.stages; ++i) {
    for (std::size_t j = 0; j <= i; ++j) product[i] += table.a[i][j] * x[j];
  }
  return product;
}

Column product(const Column& x, const Column& y) {
  Column xy(x);
  for (std::size_t i = 0; i < x.size(); ++i) xy[i] *= y[i];
  return xy;
}

/// Largest violation of the conditions of this order on the weights b. [Hairer, Norsett,
/// Wanner: Solving ODEs I, table II.2.2]
double violation(const EsdirkTable& table, const Column& b, int order) {
  const Column c = times(table), c2 = product(c, c), ac = times_a(table, c);
  const auto lacks = [&](const Column& x, double exact) {
    double sum = 0;
    for (std::size_t i = 0; i < x.size(); ++i) sum += b[i] * x[i];
    return std::abs(sum - exact);
  };
  switch (order) {
    case 1:
      return lacks(Column(c.size(), 1.0), 1);
    case 2:
      return lacks(c, 1. / 2);
    case 3:
      return std::max(lacks(c2, 1. / 3), lacks(ac, 1. / 6));
    default:
      return std::max({lacks(product(c2, c), 1. / 4), lacks(product(c, ac), 1. / 8),
                       lacks(times_a(table, c2), 1. / 12),
                       lacks(times_a(table, ac), 1. / 24)});
  }
}

/// y_1/y_0 for y' = z y with step 1.
std::complex<double> growth(const EsdirkTable& table, std::complex<double> z) {
  std::vector<std::complex<double>> y{1};
  for (std::size_t i = 1; i < table.stages; ++i) {
    std::complex<double> known = 1;
    for (std::size_t j = 0; j < i; ++j) known += z * table.a[i][j] * y[j];
    y.push_back(known / (1. - z * table.gamma()));
  }
  return y.back();
}

class Table : public testing::TestWithParam<Named> {
 protected:
  const EsdirkTable& table() const { return *GetParam().table; }
  // Published fractions of twelve digits, whose sums cancel up to terms of size 10.
  static constexpr double rounding = 1e-13;
};

TEST_P(Table, SatisfiesTheOrderConditionsAndNoMore) {
  const auto& last = table().a[table().stages - 1];
  const Column b(last.begin(), last.begin() + static_cast<long>(table().stages));
  const Column embedded(table().embedded.begin(),
                        table().embedded.begin() + static_cast<long>(table().stages));
  for (int order = 1; order <= 4; ++order) {
    if (order <= table().order) {
      EXPECT_LE(violation(table(), b, order), rounding) << order;
    }
    if (order <= table().embedded_order) {
      EXPECT_LE(violation(table(), embedded, order), 1e-12) << order;
    }
  }
  if (table().order < 4) {
    EXPECT_GT(violation(table(), b, table().order + 1), 1e-3);
  }
  EXPECT_GT(violation(table(), embedded, table().embedded_order + 1), 1e-4);
}

TEST_P(Table, HasStagesOfOrderTwoAndOneDiagonal) {
  const Column c = times(table()), ac = times_a(table(), c);
  EXPECT_EQ(c.front(), 0);
  EXPECT_NEAR(c.back(), 1, rounding);
  for (std::size_t i = 1; i < table().stages; ++i) {
    EXPECT_EQ(table().a[i][i], table().gamma());
    EXPECT_NEAR(ac[i], c[i] * c[i] / 2, rounding);
  }
}

TEST_P(Table, IsLStable) {
  EXPECT_LE(std::abs(growth(table(), -1e12)), 1e-9);
  for (double y = 1e-3; y < 1e6; y *= 1.1) {
    EXPECT_LE(std::abs(growth(table(), {0, y})), 1 + rounding) << y;
  }
}

INSTANTIATE_TEST_SUITE_P(Esdirk, Table, testing::ValuesIn(all_methods),
                         [](const auto& test) { return test.param.id; });

/// A soft strand whose root translates and turns, as in test_strands.
std::unique_ptr<System> strand(std::string_view jacobian) {
  const ModelEntry& entry = find_model("super_helix");
  Parameters p(setup_parameters(entry), "model super_helix");
  p.set("elements", "3");
  p.set("radius_m", "1e-3");
  p.set("natural_curvature_per_m", "8");
  p.set("youngs_modulus_pa", "1e6");
  p.set("mass_damping_per_s", "2");
  p.set("motion", "shake_rotate");
  p.set("jacobian", jacobian);
  return entry.make(p);
}

constexpr double end_time = 0.05;

class Strand : public testing::TestWithParam<Named> {};

// Iterated stages keep the order with a matrix that lacks terms and is as old as the
// step.
TEST_P(Strand, KeepsItsOrderWithOneInexactMatrixAStep) {
  const auto exact = strand("exact");
  Options fine;
  fine.rtol = fine.atol = 1e-13;
  Drive reference("gsl_rk8pd", *exact, fine);
  ASSERT_EQ(reference.to(end_time), Status::ok);
  std::vector<double> steps, errors;
  for (const int count : {100, 200, 400}) {
    const auto system = strand("elastic");
    Options options;
    options.step = end_time / count;
    options.refresh = Refresh::every_step;
    options.newton_tolerance = 1e-11;
    Drive drive(GetParam().id, *system, options);
    const long before = drive.integrator->stats().linearizations;
    ASSERT_EQ(drive.to(end_time), Status::ok) << drive.integrator->failure();
    const long matrices = drive.integrator->stats().linearizations - before;
    EXPECT_GE(matrices, count);
    // A stage that converges slowly with the matrix of the one before has its own.
    EXPECT_LT(static_cast<double>(matrices), count == 400 ? 1.25 * count : 4 * count);
    steps.push_back(options.step);
    errors.push_back(drive.distance(reference.integrator->q()));
  }
  EXPECT_NEAR(log_log_slope(steps, errors), GetParam().table->order, 0.25)
      << "errors from " << errors.front() << " to " << errors.back();
}

/// A curl that falls, by tolerance.
Stats falling_curl(std::string_view id, const char* model, std::string_view jacobian,
                   double tolerance) {
  const ModelEntry& entry = find_model(model);
  Parameters p(setup_parameters(entry), std::string("model ") + model);
  p.set("elements", "13");
  p.set("length_m", "0.15");
  p.set("natural_curvature_per_m", "90");
  p.set("jacobian", jacobian);
  const auto system = entry.make(p);
  Options options;
  options.tolerance = tolerance;
  options.max_work = 1e6;
  Drive drive(id, *system, options);
  EXPECT_EQ(drive.to(end_time), Status::ok) << drive.integrator->failure();
  return drive.integrator->stats();
}

// What elastic_local leaves out of its matrix makes Newton's iteration diverge beyond a
// length of step that no tolerance changes.
TEST_P(Strand, TakesShortStepsForATangentThatLacksTerms) {
  const std::string id = GetParam().id;
  const Stats stiff = falling_curl(id, "articulated_chain", "elastic", 0.1);
  const Stats less = falling_curl(id, "articulated_chain", "elastic_local", 0.1);
  EXPECT_EQ(stiff.rejected_by_newton, 0);
  EXPECT_GT(less.steps, 3 * stiff.steps);
  EXPECT_GT(less.rejected_by_newton, 0);
  EXPECT_EQ(less.rejected_by_error, 0);
}

// Where a tolerance is loose, corrections of points are large.
TEST_P(Strand, OfPointsGetsNewMatricesInEveryIterationAtLooseTolerances) {
  const Stats loose = falling_curl(GetParam().id, "der", "exact", 1e-2);
  EXPECT_GE(loose.linearizations, loose.newton_iterations);
  const Stats tight = falling_curl(GetParam().id, "der", "exact", 1e-3);
  EXPECT_LT(tight.linearizations, tight.newton_iterations);
  const Stats reduced = falling_curl(GetParam().id, "super_helix", "exact", 1e-2);
  EXPECT_LT(2 * reduced.linearizations, reduced.newton_iterations);
}

INSTANTIATE_TEST_SUITE_P(Esdirk, Strand, testing::ValuesIn(all_methods),
                         [](const auto& test) { return test.param.id; });

}  // namespace tress::test_esdirk
