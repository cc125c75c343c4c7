#include <gtest/gtest.h>

#include <cmath>

#include "contract/forms/material_points.h"
#include "math/frame.h"
#include "models/strand/geometry.h"
#include "models/strand/strand_parameters.h"
#include "tests/models/reduced/strand_cases.h"

namespace tress::testing_support {

using namespace simulation;
namespace {

Frame end_frame(System& system, In q) {
  return load9(system.material_points()->end_frame(0, q).value().data());
}

double apart(const Frame& f, const Frame& g) {
  double most = 0;
  for (const Vec& d : {f.e0 - g.e0, f.e1 - g.e1, f.e2 - g.e2}) {
    most = std::max(most, norm(d));
  }
  return most;
}

class EndFrame : public testing::TestWithParam<std::string_view> {
 protected:
  // A helix of 3/4 turn in 10 cm whose section twists by two more radians.
  const ModelSettings helix{{"natural_curvature_per_m", "35"},
                            {"natural_curvature2_per_m", "15"},
                            {"natural_twist_per_m", "20"}};
};

TEST_P(EndFrame, IsARotationWhereverTheStrandIs) {
  const auto system = make_model(GetParam(), helix);
  State s = initial_state(*system);
  std::vector<double> q_typ = s.q, v_typ = s.q;
  system->scale(q_typ, v_typ);
  for (std::size_t i = 0; i < s.q.size(); ++i) {
    s.q[i] += 0.1 * q_typ[i] * std::sin(1.0 + 3 * static_cast<double>(i));
  }
  EXPECT_TRUE(is_rotation(end_frame(*system, s.q)));
}

// The helix at rest: super_helix has its frame to rounding, grids of edges in between
// theirs, and what they do not say of the last half edge is as at rest, exactly so for
// a strand in its natural shape (edges turned onto chords and back).
TEST_P(EndFrame, IsThatOfTheHelixAtRest) {
  const Parameters parameters = parameters_of(GetParam(), helix);
  const Strand made = strand(parameters);
  const StrandPlace root{made.root.position, made.root.frame};
  const Frame exact = joints(made, ShapeOf::natural, root).back().frame;
  // dynamic_spline turns the frame onto the tangent of its interpolating spline, of order
  // 3 in the curvature times the span at an end: (44 x 0.005)^3 = 1e-2 of which natural
  // ends keep 1/4.
  const double tolerance = GetParam() == "dynamic_spline" ? 3e-3 : 1e-12;
  const auto system = make_model(GetParam(), helix);
  EXPECT_LE(apart(end_frame(*system, initial_state(*system).q), exact), tolerance);
}

// In a straight strand along x everything behind a joint turns when its twist changes:
// the last angle of the models that have one for each edge or knot.
TEST_P(EndFrame, TurnsWithTheMaterial) {
  constexpr double angle = 0.3;
  const auto system = make_model(GetParam(), {{"elements", "4"}});
  State s = initial_state(*system);
  const std::size_t n = s.q.size();
  const Frame before = end_frame(*system, s.q);
  if (GetParam() == "der" || GetParam() == "dynamic_spline") {
    s.q[n - 1] += angle;
  } else if (GetParam() == "corde" || GetParam() == "xpbd_cosserat") {
    s.q[n - 4] = 3 * std::cos(angle / 2);  // of any norm
    s.q[n - 3] = 3 * std::sin(angle / 2);
  } else {
    const double per_unit = GetParam() == "super_helix" ? 0.1 / 4 : 1;  // 1/m; rad
    s.q[n - 3] += angle / per_unit;
  }
  EXPECT_LE(apart(end_frame(*system, s.q), rotation({1, 0, 0}, angle) * before), 1e-14);
}

// A turned clamp turns a rod that keeps its shape, where its coordinates are its shape.
TEST_P(EndFrame, BeginsAtTheClamp) {
  const auto along_x = make_model(GetParam(), helix);
  ModelSettings turned = helix;
  turned.emplace_back("root_tangent", "down");
  const auto down = make_model(GetParam(), turned);
  const Frame x = end_frame(*along_x, initial_state(*along_x).q);
  const Frame clamp{{0, 0, -1}, {0, 1, 0}, {1, 0, 0}};
  EXPECT_LE(apart(end_frame(*down, initial_state(*down).q), clamp * x), 1e-13);
}

INSTANTIATE_TEST_SUITE_P(Models, EndFrame,
                         testing::Values("super_helix", "articulated_chain", "der",
                                         "corde", "xpbd_cosserat", "dynamic_spline"),
                         [](const auto& model) { return std::string(model.param); });

TEST(EndFrame, IsNoneOfPoints) {
  for (const std::string_view model : {"mass_spring", "inextensible_strand"}) {
    const auto system = make_model(model);
    EXPECT_FALSE(system->material_points()->end_frame(0, initial_state(*system).q));
  }
}

}  // namespace
}  // namespace tress::testing_support
