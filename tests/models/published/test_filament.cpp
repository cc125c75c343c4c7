#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <cstdio>

#include "integrators/catalogue.h"
#include "tests/models/published/support.h"
#include "tests/support/drive.h"

namespace tress::test_filament {

using namespace experiments;

constexpr double magnetic = 32, field_rate = 200, t_end = .01;

/// The equations as the benchmark writes them, with full matrices.
struct Printed {
  explicit Printed(const Vector& r) : points(static_cast<int>(r.size()) / 3) {
    const int n = 3 * points, segments = points - 1;
    gradient = Matrix::Zero(segments, n);
    for (int i = 0; i < segments; ++i) {
      const Vector side = 2 * (r.segment(3 * i + 3, 3) - r.segment(3 * i, 3));
      gradient.row(i).segment(3 * i, 3) = -side;
      gradient.row(i).segment(3 * i + 3, 3) = side;
    }
    projection =
        Matrix::Identity(n, n) -
        gradient.transpose() * (gradient * gradient.transpose()).ldlt().solve(gradient);
    // Rows 1 -2 1 and -2 5 -4 1 at the ends, 1 -4 6 -4 1 between.
    bending = Matrix::Zero(n, n);
    const auto put = [this](int i, int j, double entry) {
      for (int k = 0; k < 3; ++k) bending(3 * i + k, 3 * j + k) = entry;
    };
    const double ends[2][4] = {{1, -2, 1, 0}, {-2, 5, -4, 1}};
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 4; ++j) {
        put(i, j, ends[i][j]);
        put(segments - i, segments - j, ends[i][j]);
      }
    }
    const double between[5] = {1, -4, 6, -4, 1};
    for (int i = 2; i + 2 < points; ++i) {
      for (int j = 0; j < 5; ++j) put(i, i + j - 2, between[j]);
    }
    bending *= -std::pow(points, 4);
  }

  Vector flow(double t, const Vector& r) const {
    Vector force = Vector::Zero(r.size());
    const double size = points * magnetic;
    force.tail(3) << size * std::cos(field_rate * t), size * std::sin(field_rate * t), 0;
    force.head(3) = -force.tail(3);
    return projection * (bending * r + force);
  }

  int points;
  Matrix gradient, projection, bending;
};

TEST(Filament, AccelerationIsThePrintedRightSide) {
  const auto system = make_model("filament");
  DenseState s = random_state(*system, 1);
  const Printed printed(s.v);
  const Vector expected = printed.flow(s.t, s.v);
  s.a = expected;
  // Rounding of the largest term, the bending force, and of the projection's solve.
  const double terms = (printed.bending * s.v).norm();
  EXPECT_LE(residual_of(*system, s).norm(), 1e-12 * terms);
  EXPECT_GT(expected.norm(), 1e-3 * terms);
}

TEST(Filament, ElasticJacobianIsTheBenchmarksProjectedStiffness) {
  const auto system = make_model("filament", {{"jacobian", "elastic"}});
  const DenseState s = random_state(*system, 2);
  const Printed printed(s.v);
  const double h = 1e-5;
  const Matrix expected =
      Matrix::Identity(s.v.size(), s.v.size()) - h * printed.projection * printed.bending;
  const Matrix actual = tangent_of(*system, s, {1, h, h * h});
  // The tangent comes through an inverse: its rounding grows with the condition number,
  // 16 (N + 1)^4 h = 31.
  EXPECT_LE((actual - expected).norm(), 1e-11 * expected.norm());
}

Vector end_of(std::string_view integrator, const Options& options) {
  const auto system = make_model("filament");
  testing_support::Drive drive(integrator, *system, options);
  EXPECT_EQ(drive.to(t_end), Status::ok) << drive.integrator->failure();
  return vector_of(drive.integrator->v());
}

// SciMLBenchmarks has no printed end state: its reference is a run of its own. Two
// methods of different families, one explicit and one implicit, stand in for it.
TEST(Filament, TwoMethodsAgreeOnTheEndStateAndKeepLengthsAndSymmetry) {
  Options tight;
  tight.rtol = 1e-12;
  tight.atol = 1e-13;
  const Vector r = end_of("gsl_rk8pd", tight);
  Options steps;
  steps.step = t_end / 2000;
  steps.newton_tolerance = 1e-12;
  const Vector other = end_of("radau5", steps);
  std::printf("tip at the end: %.15g %.15g, radau5 %.1e away\n", r[60], r[61],
              (r - other).lpNorm<Eigen::Infinity>());
  EXPECT_LE((r - other).lpNorm<Eigen::Infinity>(), 1e-9);
  const int segments = static_cast<int>(r.size()) / 3 - 1;
  for (int i = 0; i < segments; ++i) {
    // The flow keeps lengths exactly; the error of the run does not.
    EXPECT_NEAR((r.segment(3 * i + 3, 3) - r.segment(3 * i, 3)).norm(), 1.0 / segments,
                1e-10);
    // Opposite forces on the ends: the middle rests, in the plane of the field.
    EXPECT_NEAR(r[3 * i] + r[3 * (segments - i)], 1, 1e-10);
    EXPECT_NEAR(r[3 * i + 1] + r[3 * (segments - i) + 1], 0, 1e-10);
    EXPECT_EQ(r[3 * i + 2], 0);
  }
}

TEST(Filament, ShortFilamentsKeepTheirTangent) {
  for (const char* segments : {"2", "3", "4"}) {
    const auto system = make_model("filament", {{"segments", segments}});
    const DenseState s = random_state(*system, 3);
    EXPECT_LE(tangent_error(*system, s, {1, 1e-3, 1e-6}, 3), 1e-7) << segments;
  }
}

}  // namespace tress::test_filament
