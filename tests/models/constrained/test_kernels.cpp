#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "models/constrained/angles.h"
#include "models/constrained/on_curve.h"
#include "tests/support/variable.h"

namespace tress::test_kernels {

using namespace models;

using testing_support::Dual2;
using testing_support::variable2;

// Hand-written derivatives and derivative numbers differ by the rounding of a few hundred
// operations on numbers of size `size`: 1e3 eps = 2e-13, kept at 1e-12.
constexpr double rounding = 1e-12;

Vec unit(Vec a) { return (1 / norm(a)) * a; }

const Vec e1 = unit({1, 2, -1});
const Vec e2 = unit(cross(e1, {0.3, -1, 2}));
const Vec e3 = cross(e1, e2);

template <class Kernel>
Kernel example();
template <>
Difference<Coincidence> example() {
  return {};
}
template <>
Difference<FixedDistance> example() {
  return {{0.7}};
}
template <>
Difference<OnPlane> example() {
  return {{e2}};
}
template <>
Difference<OnEllipse> example() {
  return {{e1, e2, e3, 1.3, 0.4}};
}
template <>
Difference<OnHelix> example() {
  return {{e1, e2, e3, 0.8, 0.3}};
}
template <>
Across example() {
  return {0.8};
}
template <>
Angle example() {
  return {std::cos(0.9), std::sin(0.9)};
}
template <>
Triangle example() {
  return {{0.7, 0.9, 1.1}};
}

template <class Kernel>
struct KernelDerivatives : ::testing::Test {};
using Kernels = ::testing::Types<Difference<Coincidence>, Difference<FixedDistance>,
                                 Difference<OnPlane>, Difference<OnEllipse>,
                                 Difference<OnHelix>, Across, Angle, Triangle>;
TYPED_TEST_SUITE(KernelDerivatives, Kernels);

TYPED_TEST(KernelDerivatives, AgreeWithNestedDualsAtRandomPlaces) {
  constexpr std::size_t n = TypeParam::inputs;
  constexpr std::size_t m = TypeParam::rows;
  const TypeParam kernel = example<TypeParam>();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> number(-1, 1);
  double largest_gradient = 0;
  double largest_hessian = 0;
  for (int trial = 0; trial < 20; ++trial) {
    std::array<double, n> z;
    std::array<Dual2<n>, n> duals;
    for (std::size_t i = 0; i < n; ++i) {
      z[i] = number(random);
      duals[i] = variable2<n>(z[i], i);
    }
    std::array<double, m> weight, c;
    for (double& w : weight) w = number(random);
    std::array<Dual2<n>, m> value;
    std::array<double, m * n> g;
    std::array<double, n * n> h;
    kernel.value(duals.data(), value.data());
    kernel.value(z.data(), c.data());
    kernel.gradient(z.data(), g.data());
    kernel.hessian(z.data(), weight.data(), h.data());
    for (std::size_t k = 0; k < m; ++k) {
      EXPECT_NEAR(c[k], value[k].value.value, rounding * (1 + std::abs(c[k])));
      for (std::size_t i = 0; i < n; ++i) {
        const double exact = value[k].part[i].value;
        EXPECT_NEAR(g[k * n + i], exact, rounding * (1 + std::abs(exact)));
        largest_gradient = std::max(largest_gradient, std::abs(exact));
      }
    }
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        double exact = 0;
        for (std::size_t k = 0; k < m; ++k) exact += weight[k] * value[k].part[i].part[j];
        EXPECT_NEAR(h[i * n + j], exact, 10 * rounding * (1 + std::abs(exact)));
        largest_hessian = std::max(largest_hessian, std::abs(exact));
      }
    }
  }
  EXPECT_GT(largest_gradient, 0.1);
  EXPECT_EQ(largest_hessian > 0, !TypeParam::linear);
}

struct NamedCurve {
  const char* name;
  std::shared_ptr<const FourierCurve> curve;
};

std::vector<NamedCurve> curves() {
  return {{"ellipse", ellipse({1, 2, 3}, {1, 0, 0}, {0, 0, 0.5})},
          {"helix", helix_curve({}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0.2})},
          {"trefoil", trefoil(1.5)},
          {"shake", shake({0, 0, 1}, {0.05, 0, 0}, 3)},
          {"orbit", orbit({0, 0, 1}, {0.05, 0, 0}, {0, 0.1, 0}, 2)}};
}

TEST(CurveDerivatives, AgreeWithThreefoldDuals) {
  using Three = Dual<1, Dual2<1>>;
  for (const NamedCurve& named : curves()) {
    for (const double s : {-2.0, 0.1, 0.7, 3.0}) {
      Three w;
      w.value = variable2<1>(s, 0);
      w.part[0] = 1;
      const Vec3<Three> exact = named.curve->position(w);
      const CurvePoint p = named.curve->at(s);
      const double got[3][4] = {{p.c.x, p.d1.x, p.d2.x, p.d3.x},
                                {p.c.y, p.d1.y, p.d2.y, p.d3.y},
                                {p.c.z, p.d1.z, p.d2.z, p.d3.z}};
      const Three* axes[] = {&exact.x, &exact.y, &exact.z};
      for (int k = 0; k < 3; ++k) {
        const Three& x = *axes[k];
        const double want[] = {x.value.value.value, x.part[0].value.value,
                               x.part[0].part[0].value, x.part[0].part[0].part[0]};
        for (int order = 0; order < 4; ++order) {
          // k-th derivatives of shake grow like (6 pi)^k; the argument 6 pi s itself is
          // rounded to 60 eps, hence the relative bound on the growing factor
          const double size = 1 + std::pow(6 * 3.2, order);
          EXPECT_NEAR(got[k][order], want[order], rounding * size)
              << named.name << " s=" << s << " axis " << k << " order " << order;
        }
      }
    }
  }
}

TEST(OnCurve, DerivativesAgreeWithDualsThroughTheTrefoil) {
  const std::shared_ptr<const FourierCurve> knot = trefoil(1.5);
  const OnCurve kernel{knot};
  const double z[4] = {0.3, -0.2, 0.5, 1.1};
  const double weight[3] = {0.4, -1.2, 0.8};
  double c[3], g[12], h[16];
  kernel.value(z, c);
  kernel.gradient(z, g);
  kernel.hessian(z, weight, h);
  const auto exact = knot->position(variable2<1>(z[3], 0));
  const Dual2<1> axes[] = {exact.x, exact.y, exact.z};
  double curvature = 0;
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(c[k], z[k] - axes[k].value.value, rounding);
    EXPECT_NEAR(g[4 * k + 3], -axes[k].part[0].value, rounding);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(g[4 * k + i], i == k ? 1 : 0);
    curvature -= weight[k] * axes[k].part[0].part[0];
  }
  EXPECT_NEAR(h[15], curvature, 10 * rounding);
  EXPECT_GT(std::abs(curvature), 0.1);
  for (int i = 0; i < 15; ++i) EXPECT_EQ(h[i], 0);
}

TEST(Angle, IsTheErrorInRadiansToFirstOrder) {
  const Angle kernel{std::cos(0.9), std::sin(0.9)};
  const double tilt = 1e-4;
  const double w = 0.9 + tilt;
  const double z[9] = {2, 0, 0, 0, 0, 0, 0.5 * std::cos(w), 0.5 * std::sin(w), 0};
  double c;
  kernel.value(z, &c);
  // next term: cot(theta0)/2 tilt^2 = 0.4 tilt^2
  EXPECT_NEAR(c, tilt, tilt * tilt);
}

}  // namespace tress::test_kernels
