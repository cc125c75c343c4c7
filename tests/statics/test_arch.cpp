// The deep arch of DaDeppo & Schmidt against an elastica by shooting.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

#include "experiments/statics/equilibrium_path.h"
#include "experiments/validation/rods/numerics.h"
#include "tests/statics/static_scenes.h"

namespace tress::test_arch {

using namespace experiments::statics;
using namespace testing_support;
using experiments::validation::integrate_scaled;

constexpr double half_angle = 107.5 * std::numbers::pi / 180;  // of 215 degrees

/// The inextensible elastica of radius 1 and EI = 1, clamped on the left, hinged on the
/// right, with a force P down at the crown. With the tangent angle a, the moment m, and
/// the force n in the section,
///
///     x' = cos a, z' = sin a, a' = m - 1, m' = n_x sin a - n_z cos a,
///
/// and n_z grows by P at the crown. It runs clockwise.
class Elastica {
 public:
  /// P at which the crown has moved down by `drop`, near the last solution.
  double load(double drop) {
    constexpr double enough = 1e-12;
    for (int i = 0; i < 30; ++i) {
      const Eigen::Vector4d off = misfit(unknown_, drop);
      Eigen::Matrix4d slope;
      for (int j = 0; j < 4; ++j) {
        constexpr double step = 1e-6;
        Eigen::Vector4d ahead = unknown_, behind = unknown_;
        ahead[j] += step;
        behind[j] -= step;
        slope.col(j) = (misfit(ahead, drop) - misfit(behind, drop)) / (2 * step);
      }
      const Eigen::Vector4d change = slope.partialPivLu().solve(off);
      unknown_ -= change;
      if (change.norm() < enough) break;
    }
    return unknown_[3];
  }

 private:
  static std::vector<double> integrate(double nx, double nz, std::vector<double> y) {
    const auto slope = [=](double, const double* at, double* rate) {
      const double c = std::cos(at[2]), s = std::sin(at[2]);
      rate[0] = c;
      rate[1] = s;
      rate[2] = at[3] - 1;
      rate[3] = nx * s - nz * c;
    };
    return integrate_scaled(slope, 0, half_angle, std::move(y));
  }

  /// n_x, n_z, m at the clamp and P, against the place of the hinge, no moment there, and
  /// the place of the crown.
  static Eigen::Vector4d misfit(const Eigen::Vector4d& u, double drop) {
    const double left = std::numbers::pi / 2 + half_angle;
    const double x = std::cos(left), z = std::sin(left);
    const auto crown = integrate(u[0], u[1], {x, z, left - std::numbers::pi / 2, u[2]});
    const auto end = integrate(u[0], u[1] + u[3], crown);
    return {end[0] + x, end[1] - z, end[3], crown[1] - (1 - drop)};
  }

  Eigen::Vector4d unknown_ = Eigen::Vector4d::Zero();
};

/// The largest load: the crown has moved down by 1.137 there. The load is a parabola
/// within 1e-9 around it, of three loads 2e-3 apart.
double limit_of_elastica() {
  Elastica elastica;
  for (double drop = 0.02; drop < 1.131; drop += 0.03) elastica.load(drop);
  constexpr double h = 2e-3;
  double at = 1.137;
  double limit = 0;
  for (int i = 0; i < 4; ++i) {
    const double a = elastica.load(at - h), b = elastica.load(at),
                 c = elastica.load(at + h);
    const double slope = (c - a) / 2, curvature = a - 2 * b + c;
    limit = b - slope * slope / (2 * curvature);
    at -= h * slope / curvature;
  }
  return limit;
}

/// The same arch, of radius 0.1 m; the factor is P R^2/EI.
std::string arch(const std::string& model, int elements) {
  const double left = std::numbers::pi / 2 + half_angle;
  const auto number = [](double x) {
    char text[32];
    std::snprintf(text, sizeof text, "%.17g", x);
    return std::string(text);
  };
  return static_scene(
      model,
      "length_m = " + number(0.2 * half_angle) + "\nelements = " +
          std::to_string(elements) + "\nposition_m = [" + number(0.1 * std::cos(left)) +
          ", 0, " + number(0.1 * std::sin(left)) + "]\nroot_tangent = [" +
          number(std::sin(left)) + ", 0, " + number(-std::cos(left)) +
          "]\nshape = \"along\"\ndarboux_along = [[0, 0, 10, 0]]\n",
      "[[supports]]\nat = \"tip\"\n[[effects.point_force]]\nat = 0.5\nforce_n = [0, 0, " +
          number(-bending_of_strand / 0.01) + "]\n");
}

/// Follows the path until the first limit point, whose factor it returns.
double limit_of(const std::string& model, int elements) {
  StaticStrand strand = static_strand(arch(model, elements), "point_force=0..12");
  const auto path =
      equilibrium_path(strand, {.resolution = 0.06, .points = 600, .limit_points = 1});
  for (const PathPoint& point : path) EXPECT_EQ(point.failure, "");
  const std::vector<double> limits = values_at(path, Event::limit_point);
  EXPECT_GE(limits.size(), 1U) << model;
  return limits.empty() ? 0 : limits.front();
}

/// The published load has three digits.
TEST(Arch, OfTheElasticaHasThePublishedLimitLoad) {
  EXPECT_NEAR(limit_of_elastica(), 8.97, 0.005);
}

/// Elements of constant curvature err by order 2: 0.5 % with 40, 0.12 % with 80. Their
/// extrapolation errs by order 4, which is that of clothoids: 1e-5 with 40, 2e-4 with 20.
TEST(Arch, SnapsAtTheLoadOfTheElastica) {
  const double expected = limit_of_elastica();
  const std::string planar = "\"\nmodes = \"bend_planar\"";
  const double coarse = limit_of("id = \"super_helix" + planar, 30);
  const double fine = limit_of("id = \"super_helix" + planar, 60);
  const double clothoid = limit_of("id = \"super_clothoid" + planar, 20);
  std::printf(
      "elastica %.6f, super_helix 30: %+.1e, 60: %+.1e, super_clothoid 20: %+.1e\n",
      expected, coarse / expected - 1, fine / expected - 1, clothoid / expected - 1);
  EXPECT_NEAR(fine / expected, 1, 0.005);
  EXPECT_NEAR((coarse - expected) / (fine - expected), 4, 0.4);
  EXPECT_NEAR(clothoid / expected, 1, 5e-4);
}

/// A support that leads the crown down passes the limit load as the largest force. The
/// force is a parabola of the drop there, with a curvature of 200 EI/R^4 by the loads of
/// the elastica. Points are 0.009 R apart: the largest misses at most 2e-3 EI/R^2, 2e-4.
TEST(Arch, HasThatLoadUnderASupportThatLeadsItsCrown) {
  std::string text = arch("id = \"super_clothoid\"\nmodes = \"bend_planar\"", 20);
  text.resize(text.find("[[effects.point_force]]"));
  text +=
      "[[supports]]\nat = 0.5\nslide = [1, 0, 0]\nkeyframes = [[0, 0, 0, 0.1], [1, 0, 0, "
      "-0.015]]\n";
  StaticStrand strand = static_strand(text, "supports=0..1");
  const auto path = equilibrium_path(strand, {.resolution = 0.004});
  std::vector<double> force;
  for (const PathPoint& point : path) {
    EXPECT_EQ(point.failure, "");
    EXPECT_EQ(point.stability.negative, 0);
    force.push_back(-point.forces[1].z * 0.01 / bending_of_strand);
  }
  const auto largest = std::ranges::max_element(force);
  ASSERT_NE(largest, force.end() - 1);
  std::printf("largest force %.5f of %zu points\n", *largest, force.size());
  EXPECT_NEAR(*largest / limit_of_elastica(), 1, 1e-3);
}

/// In space the arch leaves its plane first: two bifurcations before the limit point,
/// which a path in the plane passes. Edges err by order 2: 5.5 % with 40, 1.4 % with 80,
/// and 0.5 % or less extrapolated.
TEST(Arch, OfEdgesSnapsThereWhenExtrapolated) {
  const double coarse = limit_of("id = \"der\"", 24), fine = limit_of("id = \"der\"", 48);
  const double expected = limit_of_elastica();
  std::printf("der 24: %+.1e, 48: %+.1e, extrapolated %+.1e\n", coarse / expected - 1,
              fine / expected - 1, (4 * fine - coarse) / 3 / expected - 1);
  EXPECT_NEAR((4 * fine - coarse) / 3 / expected, 1, 0.005);
}

/// The arch that tilts joins two bifurcations of the symmetric one, to the left and to
/// the right: a closed path, on which the parameter turns back at each of them. Events
/// are located to 1e-7 of a step, and where branches cross to its square root.
TEST(Arch, ThatTiltsBetweenTwoBifurcationsClosesItsPath) {
  const std::string scene = static_scene(
      "id = \"super_clothoid\"\nmodes = \"bend_planar\"",
      "length_m = 0.1\nelements = 12\nposition_m = [-0.0479425538604203, 0, 0]\n"
      "root_tangent = [0.8775825618903728, 0, 0.479425538604203]\nshape = \"along\"\n"
      "darboux_along = [[0, 0, 10, 0]]\n",
      "[[supports]]\nat = \"tip\"\nkind = \"clamp\"\n[[supports]]\nat = 0.5\n"
      "slide = [1, 0, 0]\n"
      "keyframes = [[0, 0, 0, 0.012241743810962725], [1, 0, 0, -0.0115]]\n");
  const auto whole = static_path(scene, "supports=0..1");
  const std::vector<double> bifurcations = values_at(whole, Event::bifurcation);
  ASSERT_EQ(bifurcations.size(), 2U);
  EXPECT_EQ(whole.back().event, Event::end);
  for (const int side : {1, -1}) {
    const auto branch = static_path(scene, "supports=0..1", {.branch = side});
    ASSERT_EQ(branch.back().event, Event::closed) << branch.back().failure;
    const std::vector<double> turns = values_at(branch, Event::limit_point);
    ASSERT_EQ(turns.size(), 2U);
    EXPECT_NEAR(turns[0], bifurcations[1], 1e-4);
    EXPECT_NEAR(turns[1], bifurcations[0], 1e-4);
    const auto first = std::ranges::find(branch, Event::branch, &PathPoint::event);
    ASSERT_NE(first, branch.end());
    EXPECT_LT(norm(tip_of(*first) - tip_of(branch.back())), 1e-9);
    EXPECT_NEAR(first->at.value, branch.back().at.value, 0.04);
  }
}

}  // namespace tress::test_arch
