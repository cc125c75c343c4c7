// Elements whose lengths follow the shape at rest.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "contract/forms/material_points.h"
#include "models/clothoid/super_clothoid.h"
#include "models/cut/graded_cut.h"
#include "models/strand/geometry.h"

namespace tress::test_graded_cut {

using namespace models;

/// Places at `count` even steps of arc length.
std::vector<Vec> places(const LoadedRod& rod, const std::vector<double>& lengths,
                        int count) {
  Strand strand = cut_into(rod, lengths);
  const std::vector<double> q = coordinates_at_rest(strand, rod.load);
  std::vector<Vec> all;
  StrandPlace at{{}, rod.clamp};
  double start = 0;
  std::size_t k = 0;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    const Vec kappa = load3(&q[3 * i]);
    const auto beyond = [&](double s) {
      Segment piece = strand.segments[i];
      piece.parent = -1;
      piece.length = s;
      piece.natural = kappa;
      Strand alone = strand;
      alone.segments = {piece};
      return joints(alone, ShapeOf::natural, at).back();
    };
    while (k < static_cast<std::size_t>(count) &&
           rod.length * static_cast<double>(k + 1) / count <=
               start + lengths[i] * (1 + 1e-9)) {
      all.push_back(beyond(rod.length * static_cast<double>(k + 1) / count - start).x);
      ++k;
    }
    at = beyond(lengths[i]);
    start += lengths[i];
  }
  return all;
}

/// Height over width of the tip of a horizontally clamped rod under its weight, Gamma = w
/// L^3/EI, by shooting from the tip: delta = pi/2 - theta obeys delta'' = Gamma sigma sin
/// delta, delta'(0) = 0, delta(1) = pi/2, sigma = (L - s)/L.
double height_over_width(double gamma) {
  const auto shot = [gamma](double log_tip, double& x, double& z) {
    constexpr int steps = 4000;
    const double h = 1.0 / steps;
    double d = std::exp(log_tip), rate = 0;
    x = z = 0;
    for (int i = 0; i < steps && d < 1.6; ++i) {
      const double sigma = i * h;
      const auto pull = [&](double at, double angle) {
        return gamma * at * std::sin(angle);
      };
      const double k1 = pull(sigma, d), d2 = d + h / 2 * rate;
      const double k2 = pull(sigma + h / 2, d2), d3 = d2 + h * h / 4 * k1;
      const double k3 = pull(sigma + h / 2, d3), d4 = d + h * rate + h * h / 2 * k2;
      const double k4 = pull(sigma + h, d4);
      const double next = d + h * rate + h * h / 6 * (k1 + k2 + k3);
      const double middle = (d2 + d3) / 2;
      x += h / 6 * (std::sin(d) + 4 * std::sin(middle) + std::sin(next));
      z += h / 6 * (std::cos(d) + 4 * std::cos(middle) + std::cos(next));
      rate += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
      d = next;
    }
    return d;
  };
  double low = -40, high = std::log(std::numbers::pi / 2), x = 0, z = 0;
  for (int i = 0; i < 100; ++i) {
    const double middle = (low + high) / 2;
    (shot(middle, x, z) < std::numbers::pi / 2 ? low : high) = middle;
  }
  shot(low, x, z);
  return z / x;
}

LoadedRod cantilever(double gamma) {
  LoadedRod rod;
  rod.length = 0.1;
  rod.natural = uniform_shape({});
  const double bending = stiffness(rod.material, rod.section).y;
  rod.load = {0, 0, -gamma * bending / std::pow(rod.length, 3)};
  return rod;
}

double cantilever_error(double gamma, const std::vector<double>& lengths) {
  const Vec tip = places(cantilever(gamma), lengths, 1).back();
  return std::abs(-tip.z / tip.x / height_over_width(gamma) - 1);
}

TEST(GradedCut, BendsACantileverAsTheElastica) {
  EXPECT_NEAR(height_over_width(1e-3) / (1e-3 / 8), 1, 1e-3);  // small loads
  EXPECT_NEAR(height_over_width(1000) / 21.33544, 1, 1e-4);    // [Romero et al. 2021]
  const double twelve = cantilever_error(1000, graded_cut(cantilever(1000), 12).lengths),
               sixteen = cantilever_error(1000, graded_cut(cantilever(1000), 16).lengths),
               equal = cantilever_error(1000, std::vector<double>(16, 0.1 / 16));
  EXPECT_LE(twelve, 0.005);
  EXPECT_LE(sixteen, 0.0015);
  EXPECT_GT(equal, 0.05);
}

TEST(GradedCut, LeavesEqualWhatVariesNowhere) {
  LoadedRod rod = cantilever(0);
  rod.natural = uniform_shape({10, 50, 0});
  const GradedCut cut = graded_cut(rod, 7);
  for (const double length : cut.lengths) EXPECT_NEAR(length, 0.1 / 7, 1e-12);
  EXPECT_LE(cut.error, 1e-12);
}

double clothoid_error(double gamma, const std::vector<double>& lengths) {
  const LoadedRod rod = cantilever(gamma);
  const Strand strand = cut_into(rod, lengths);
  const std::vector<double> q =
      coordinates_at_rest(strand, rod.load, ElementStrain::linear);
  const auto system = super_clothoid(strand, {}, {});
  MaterialPoints& points = *system->material_points();
  std::vector<double> x(3 * static_cast<std::size_t>(points.count()));
  points.positions(0, q, x);
  const Vec tip = load3(&x[x.size() - 3]);
  return std::abs(-tip.z / tip.x / height_over_width(gamma) - 1);
}

/// Fewer clothoids than helices do, if they are where curvature bends; equal ones waste
/// all but one of theirs on the part that hangs.
TEST(LinearCut, NeedsFewClothoidsOfAHeavyCantilever) {
  for (const int n : {4, 6, 8}) {
    const double equal = clothoid_error(
                     1000, std::vector<double>(static_cast<std::size_t>(n), 0.1 / n)),
                 graded = clothoid_error(1000, linear_cut(cantilever(1000), n)),
                 helices =
                     cantilever_error(1000, graded_cut(cantilever(1000), 2 * n).lengths);
    RecordProperty("equal_" + std::to_string(n), std::to_string(equal));
    RecordProperty("graded_" + std::to_string(n), std::to_string(graded));
    RecordProperty("helices_" + std::to_string(2 * n), std::to_string(helices));
    EXPECT_LT(10 * graded, equal) << n;
    // As many unknowns; with fewer the fourth order has not set in.
    if (n == 8) {
      EXPECT_LT(2 * graded, helices);
    }
  }
}

TEST(LinearCut, LeavesEqualWhatBendsNowhere) {
  LoadedRod rod = cantilever(0);
  rod.natural = [](double s) { return Vec{0, 300 * s, 0}; };
  for (const double length : linear_cut(rod, 5)) EXPECT_NEAR(length, 0.02, 1e-9);
}

}  // namespace tress::test_graded_cut
