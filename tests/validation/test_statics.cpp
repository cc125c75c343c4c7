#include <gtest/gtest.h>

#include <cmath>

#include "contract/input_error.h"
#include "experiments/validation/rods/rod.h"
#include "experiments/validation/rods/statics.h"
#include "math/gauss_legendre.h"

namespace tress::test_statics {

using namespace experiments;
using namespace experiments::validation;

constexpr Vec axis_x{1, 0, 0}, axis_y{0, 1, 0}, axis_z{0, 0, 1};

ModelVariant variant(std::string_view id, ModelSettings settings = {}) {
  return {&find_model(id), std::move(settings), ""};
}

TestRod curl() {
  TestRod rod;
  rod.natural = uniform_shape({8, 20, 5});
  return rod;
}

class Rods : public testing::TestWithParam<ModelVariant> {};

std::string name(const testing::TestParamInfo<ModelVariant>& info) {
  std::string text(info.param.model->id);
  for (const auto& [key, word] : info.param.settings) text += "_" + word;
  return text;
}

/// A curl that hangs in its weight.
Statics hanging(const ModelVariant& of, const End& end) {
  const TestRod rod = curl();
  return {of, rod.strand(6, hanging_clamp()), -rod.gravity(5) * axis_z, end};
}

// The force that holds a tip is the force that brings it there: the same equilibrium
// twice, once with the force given and once with the place, from a little beside it.
// Rounding of stretch that is 2.5e7 times as stiff as bending leaves 1e-6 of the force.
TEST_P(Rods, HoldAPlaceByTheForceThatLeadsThere) {
  const TestRod rod = curl();
  const Vec force = rod.force() * Vec{0.7, 0.4, -0.2};
  Statics free = hanging(GetParam(), {.force = force});
  free.follow(0.1, 0.99);
  Statics held = hanging(GetParam(), {.along = {axis_x, axis_y, axis_z}});
  held.start_at(free);
  free.relax(1);
  held.hold_at(free.tip());
  held.relax(1);
  const Vec away = held.tip() - free.tip();
  EXPECT_LE(norm(away), 1e-9 * rod.length);
  const std::vector<double> found = held.holding();
  const double wanted[3] = {force.x, force.y, force.z};
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(found[k], wanted[k], 1e-5 * rod.force());
  }
}

// The same for a section: held where it is, it takes no moment.
TEST_P(Rods, HoldTheirOwnSectionByNothing) {
  if (!no_section(GetParam()).empty()) GTEST_SKIP() << no_section(GetParam());
  const TestRod rod = curl();
  Statics free = hanging(GetParam(), {});
  free.follow(0.1, 1);
  const auto axes = free.system().material_points()->end_frame(1, free.q()).value();
  Statics held =
      hanging(GetParam(), {.section = End::Section::frame, .frame = load9(axes.data())});
  held.start_at(free);
  held.relax(1);
  for (const double moment : held.holding()) {
    EXPECT_LE(std::abs(moment), 1e-6 * rod.bending() / rod.length);
  }
}

// A hanging rod is stable, and so is a standing one below Greenhill's weight (7.84; six
// elements are 5 % off at most), not above.
TEST_P(Rods, StandUpToGreenhillsWeight) {
  const TestRod rod;
  const Strand up = rod.strand(6, standing_clamp());
  for (const double gamma : {6.0, 9.0}) {
    Statics statics(GetParam(), up, -rod.gravity(gamma) * axis_z);
    statics.relax(1);
    EXPECT_EQ(statics.least_square() > 0, gamma < 7) << gamma;
  }
}

INSTANTIATE_TEST_SUITE_P(Statics, Rods,
                         testing::Values(variant("super_helix"),
                                         variant("articulated_chain"), variant("der"),
                                         variant("der", {{"stretch", "inextensible"}}),
                                         variant("corde"), variant("xpbd_cosserat"),
                                         variant("dynamic_spline"),
                                         variant("kirchhoff_nodal")),
                         name);

// Of a strand of one segment along (sin(angle s), cos(angle s), s) the tip is the
// polynomial's through the points, off by max |x^(n)|/n! prod (1 - s_k) per component, n!
// angle^n/(2n)! for Gauss's points; rounding grows with the sum of the weights' sizes, 2n
// at most.
TEST(TipForce, FindsTheTipFromAnyNumberOfPoints) {
  for (const auto& [angle, n] :
       {std::pair(0.28, 4), {25.0, 32}, {41.5, 36}, {55.0, 44}}) {
    std::vector<double> x, mass, length;
    for (const QuadraturePoint& point : gauss_legendre(n, 1)) {
      x.insert(x.end(),
               {std::sin(angle * point.at), std::cos(angle * point.at), point.at});
      mass.push_back(point.weight);
      length.push_back(point.weight);
    }
    const double off =
        std::exp(n * std::log(angle) + std::lgamma(n + 1.0) - std::lgamma(2.0 * n + 1));
    const double rounding = 2.0 * n * n * 2.2e-16;
    TipForce tip(1);
    tip.force = {1, 0, 0};
    EXPECT_NEAR(-tip.potential(0, {n, x, {}, {}, mass, length}), std::sin(angle),
                off + rounding)
        << n;
    EXPECT_LT(off, 1e-3) << "nothing to see";
  }
}

// Each element of this coil winds by 55 rad: 44 points each. A force of a thousandth of
// EI/L^2 bends it next to nothing.
TEST(Statics, CoilsOfManyTurnsAnElementAreInEquilibrium) {
  TestRod rod;
  rod.natural = uniform_shape({0, 5500, 0});
  const Strand strand = rod.strand(10, horizontal_clamp());
  Statics statics(variant("super_helix"), strand, {},
                  {.force = (1e-3 * rod.force()) * axis_z});
  const Vec before = statics.tip();
  EXPECT_NO_THROW(statics.relax(1));
  EXPECT_LE(norm(statics.tip() - before), 1e-3 * rod.length);
}

TEST(Statics, CoilsOfAThousandTurnsAnElementAreRefused) {
  TestRod rod;
  rod.natural = uniform_shape({0, 1e6, 0});
  const Strand strand = rod.strand(10, horizontal_clamp());  // 10 000 rad each
  EXPECT_THROW(Statics(variant("super_helix"), strand, {}), InputError);
}

// Gradients of a section's rows against differences of order 4 (other steps), their
// curvature against differences of the gradients: 1e-8 of its size.
TEST(EndConditions, DifferentiateTheSection) {
  for (const std::string_view model : {"super_helix", "der", "corde", "dynamic_spline"}) {
    const TestRod rod = curl();
    const auto system = on_strand(variant(model), rod.strand(3, horizontal_clamp()), {});
    const End end{.along = {axis_z},
                  .section = End::Section::frame,
                  .frame = rotation({0, 1, 0}, 0.4)};
    EndConditions conditions(*system, end);
    const auto n = static_cast<std::size_t>(system->layout().coordinates);
    std::vector<double> q(n), v(n), q_typ(n);
    system->initial_state(q, v);
    system->scale(q_typ, v);
    const Eigen::MatrixXd g = conditions.gradient(0, q);
    const Eigen::Vector3d moment(0.3, -0.5, 0.8);
    const Eigen::MatrixXd curvature = conditions.curvature(0, q, moment);
    for (std::size_t j = 0; j < n; ++j) {
      const double e = 5e-4 * q_typ[j];
      const auto shifted = [&](double by) {
        std::vector<double> moved = q;
        moved[j] += by * e;
        return moved;
      };
      const auto slope = [&](auto&& f) -> Eigen::VectorXd {
        return (8 * (f(shifted(1)) - f(shifted(-1))) - (f(shifted(2)) - f(shifted(-2)))) /
               (12 * e);
      };
      const auto column = static_cast<Eigen::Index>(j);
      const Eigen::VectorXd of_value =
          slope([&](const std::vector<double>& at) { return conditions.value(0, at); });
      const Eigen::VectorXd of_gradient = slope([&](const std::vector<double>& at) {
        return Eigen::VectorXd(conditions.gradient(0, at).rightCols(3) * moment);
      });
      const double size = q_typ[j];
      EXPECT_LE((of_value - g.row(column).transpose()).cwiseAbs().maxCoeff() * size, 1e-9)
          << model << " " << j;
      for (std::size_t i = 0; i < n; ++i) {
        const auto row = static_cast<Eigen::Index>(i);
        EXPECT_NEAR(of_gradient[row] * size * q_typ[i],
                    curvature(row, column) * size * q_typ[i], 1e-6)
            << model << " " << i << " " << j;
      }
    }
  }
}

}  // namespace tress::test_statics
