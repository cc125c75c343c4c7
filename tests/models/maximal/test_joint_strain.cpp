#include <gtest/gtest.h>

#include <random>

#include "math/dual.h"
#include "models/maximal/joint_strain.h"
#include "models/maximal/rod_edge.h"

// Strains of a discrete rod against derivative numbers.

namespace tress::test_joint_strain {

using namespace models;

std::mt19937 source(3);
double uniform() { return std::uniform_real_distribution<double>(-1, 1)(source); }
Vec random_vector() { return {uniform(), uniform(), uniform()}; }
Frame random_frame() {
  const Vec axis = random_vector();
  return rotation((1 / norm(axis)) * axis, 3 * uniform());
}

using First = Dual<6>;
using Second = Dual<6, First>;

/// Coordinate k as a number with first and second derivatives by all six.
Second variable(double value, int k) {
  Second x{First(value)};
  x.value.part[static_cast<std::size_t>(k)] = 1;
  x.part[static_cast<std::size_t>(k)] = First(1);
  return x;
}

/// The frame turned by exp([w]x) to second order.
FrameOf<Second> turned(const Frame& f, const Vec3<Second>& w) {
  const auto turn = [&](const Vec& y0) {
    const Vec3<Second> y(y0), wy = cross(w, y);
    return y + wy + Second(First(0.5)) * cross(w, wy);
  };
  return {turn(f.e0), turn(f.e1), turn(f.e2)};
}

TEST(JointStrain, DerivativesAgreeWithDualNumbers) {
  for (int trial = 0; trial < 20; ++trial) {
    const Frame minus = random_frame();
    const Frame plus =
        minus * rotation({0, 0.6, 0.8}, uniform()) * rotation({1, 0, 0}, 2 * uniform());
    const Vec3<Second> u(variable(0, 0), variable(0, 1), variable(0, 2));
    const Vec3<Second> w(variable(0, 3), variable(0, 4), variable(0, 5));
    const Vec3<Second> exact = joint_strain(turned(minus, u), turned(plus, w));
    const JointStrain strain(minus, plus);

    const Second strains[3] = {exact.x, exact.y, exact.z};
    const Vec gradients[3] = {strain.twist, strain.curvature1, strain.curvature2};
    const double values[3] = {strain.value.x, strain.value.y, strain.value.z};
    for (int m = 0; m < 3; ++m) {
      EXPECT_DOUBLE_EQ(strains[m].value.value, values[m]);
      const Vec& g = gradients[m];
      const double gradient[6] = {-g.x, -g.y, -g.z, g.x, g.y, g.z};
      const TwoVectorForm form = strain.second(
          minus, plus, {m == 0 ? 1.0 : 0, m == 1 ? 1.0 : 0, m == 2 ? 1.0 : 0});
      double largest = 0;
      for (std::size_t k = 0; k < 6; ++k) {
        // A dozen products of numbers up to |kappa|/c.
        EXPECT_NEAR(strains[m].value.part[k], gradient[k], 1e-13);
        for (std::size_t l = 0; l < 6; ++l) {
          const double entry = form.at(static_cast<int>(k), static_cast<int>(l));
          EXPECT_NEAR(strains[m].part[k].part[l], entry, 1e-12) << m << k << l;
          largest = std::max(largest, std::abs(entry));
        }
      }
      EXPECT_GT(largest, 1e-2);
    }
  }
}

TEST(JointStrain, IsTheAngleOfASimpleTurn) {
  const Frame start = random_frame();
  for (const double angle : {-1.0, 0.3, 2.0}) {
    const Vec bent1 = joint_strain(start, start * rotation({0, 1, 0}, angle));
    const Vec bent2 = joint_strain(start, start * rotation({0, 0, 1}, angle));
    const Vec twisted = joint_strain(start, start * rotation({1, 0, 0}, angle));
    EXPECT_NEAR(bent1.y, 2 * std::tan(angle / 2), 1e-14);
    EXPECT_NEAR(bent2.z, 2 * std::tan(angle / 2), 1e-14);
    EXPECT_NEAR(twisted.x, angle, 1e-14);
    EXPECT_NEAR(std::abs(bent1.x) + std::abs(bent2.x) + std::abs(twisted.y), 0, 1e-14);
  }
}

TEST(EdgeTurn, IsTheTurnOfTheMaterialFrame) {
  for (int trial = 0; trial < 20; ++trial) {
    const Frame reference = random_frame();
    const Vec e = 0.01 * (reference.e0 + 0.8 * random_vector());
    const double theta = 2 * uniform();
    const Vec de = 0.01 * random_vector();
    const double dtheta = uniform();
    // The frame along e + s de, theta + s dtheta.
    using Along = Dual<1, Dual<1>>;
    const auto moving = [](double at, double rate) {
      Along x{Dual<1>(at)};
      x.value.part[0] = rate;
      x.part[0] = Dual<1>(rate);
      return x;
    };
    const FrameOf<Along> f = edge_frame(
        reference, Vec3<Along>(moving(e.x, de.x), moving(e.y, de.y), moving(e.z, de.z)),
        moving(theta, dtheta));
    const EdgeTurn turn(reference.e0, e);
    const Frame frame = edge_frame(reference, e, theta);
    EXPECT_TRUE(is_rotation(frame));
    const Vec spin = turn.spin(de, dtheta);
    Vec by_columns = dtheta * turn.column(3);
    for (int k = 0; k < 3; ++k) by_columns = by_columns + (&de.x)[k] * turn.column(k);
    EXPECT_NEAR(norm(by_columns - spin), 0, 1e-12);
    // y'' = w x (w x y) + Q x y for w(s) = spin s + Q s^2/2.
    Vec q;
    for (int k = 0; k < 3; ++k) {
      const Vec moment{k == 0 ? 1.0 : 0, k == 1 ? 1.0 : 0, k == 2 ? 1.0 : 0};
      Pack h[4] = {};
      turn.add_second(1, moment, h);
      const double y[4] = {de.x, de.y, de.z, dtheta};
      double sum = 0;
      for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) sum += y[i] * h[i][j] * y[j];
      }
      q = q + sum * moment;
      EXPECT_NEAR(dot(moment, spin),
                  dot(turn.force(moment), de) + dot(moment, turn.t) * dtheta, 1e-12);
    }
    const Vec axes[3] = {frame.e0, frame.e1, frame.e2};
    const Vec3<Along> exact[3] = {f.e0, f.e1, f.e2};
    for (int k = 0; k < 3; ++k) {
      const Vec first = cross(spin, axes[k]);
      const Vec second = cross(spin, first) + cross(q, axes[k]);
      const Vec rate{exact[k].x.part[0].value, exact[k].y.part[0].value,
                     exact[k].z.part[0].value};
      const Vec rate2{exact[k].x.part[0].part[0], exact[k].y.part[0].part[0],
                      exact[k].z.part[0].part[0]};
      const Vec off = rate - first, off2 = rate2 - second;
      // Spins up to 3, their squares up to 10.
      EXPECT_LT(norm(off), 1e-13);
      EXPECT_LT(norm(off2), 1e-11);
    }
  }
}

}  // namespace tress::test_joint_strain
