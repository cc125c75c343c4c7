#include <gtest/gtest.h>

#include "contract/input_error.h"
#include "models/effects/body.h"
#include "models/effects/gravity.h"
#include "models/effects/linear_drag.h"
#include "tests/models/effects/settle.h"
#include "tests/models/effects/sphere_grid.h"

namespace tress::test_body {

using namespace models;

using testing_support::Cloud;
using testing_support::FreePoints;
using testing_support::load;
using testing_support::sphere_samples;
using testing_support::straight;

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double g = 9.81;           // m/s^2
constexpr double per_length = 0.01;  // kg/m
constexpr double stiffness = 1000;   // N/m^2
constexpr double radius = 1e-3;      // m, of the strand

const Gravity gravity({0, 0, -g});

// w^2 = k/(rho A), w = 316/s; critically damped, so that 0.2 s leave (1 + 63) exp(-63) of
// the way.
TEST(Body, AStrandAtRestOnAPlaneSinksByItsWeightOverTheStiffness) {
  const Body plane(Plane{}, {}, {.stiffness = stiffness, .offset = radius});
  const LinearDrag drag(0, 2 * std::sqrt(stiffness / per_length));
  const double depth = per_length * g / stiffness;
  for (const std::size_t points : {3U, 12U}) {
    FreePoints strand(straight(points, 0.3, per_length, radius),
                      {&gravity, &plane, &drag});
    strand.run(0.2, 1000);
    // |z| 1e-3 against a depth of 1e-4: some ten eps.
    for (std::size_t i = 0; i < points; ++i) {
      EXPECT_NEAR(radius - strand.place(i).z, depth, 1e-13 * depth);
    }
    EXPECT_NEAR(*plane.penetration(0, strand.points.x), depth, 1e-13 * depth);
  }
}

/// A strand across a slope of given tangent, in equilibrium with the plane but free to
/// slide; x of the result is its velocity downhill.
class Slope {
 public:
  static constexpr double friction = 0.5, slip = 1e-3;

  explicit Slope(double tangent)
      : angle_(std::atan(tangent)),
        plane_(Plane{}, {{}, rotation({0, 1, 0}, angle_)},
               {.stiffness = stiffness, .friction = friction, .slip = slip}),
        strand_(straight(2, 0.3, per_length, 0), {&gravity, &plane_}) {
    const Vec normal{std::sin(angle_), 0, std::cos(angle_)};
    const double depth = per_length * g * std::cos(angle_) / stiffness;
    for (std::size_t i = 0; i < 2; ++i) {
      store3(-depth * normal, &strand_.points.x[3 * i]);
    }
  }
  double speed_after(double duration, int steps) {
    strand_.run(duration, steps);
    return dot(strand_.velocity(0), {std::cos(angle_), 0, -std::sin(angle_)});
  }
  double angle() const { return angle_; }

 private:
  double angle_;
  Body plane_;
  FreePoints strand_;
};

// Where f_1(y) = 2 y/v - (y/v)^2 holds tan(angle)/mu: y/v = 1 - sqrt(1 - tan(angle)/mu).
// The creep is approached at 2 mu g cos(angle) sqrt(1 - 0.8)/v = 4000/s: 80 times 1/e.
TEST(Body, ABlockOnASlopeBelowTheFrictionAngleCreepsBelowTheSlipSpeed) {
  Slope slope(0.8 * Slope::friction);
  const double speed = slope.speed_after(0.02, 2000);
  EXPECT_NEAR(speed, Slope::slip * (1 - std::sqrt(1 - 0.8)), 1e-12 * Slope::slip * 100);
  EXPECT_LE(speed, Slope::slip);
}

// Beyond the slip speed the deceleration is mu g cos(angle) exactly, and the normal load
// stays in equilibrium up to rounding.
TEST(Body, ABlockOnASlopeAboveTheFrictionAngleSlides) {
  Slope slope(1.2 * Slope::friction);
  const double before = slope.speed_after(0.02, 2000);
  const double after = slope.speed_after(0.05, 1000);
  EXPECT_GT(before, Slope::slip);
  const double expected =
      g * (std::sin(slope.angle()) - Slope::friction * std::cos(slope.angle()));
  EXPECT_NEAR((after - before) / 0.05, expected, 1e-10 * expected);
}

// m y dy/dd = -k l d (1 + c y) with y = d' separates; from d = 0 to d = 0
//
//     c v_0 - ln(1 + c v_0) = -c v_1 - ln(1 - c v_1).
//
// In the step in which contact ends the method may err by the force of one step's depth
// over that step, w^2 h^2 v with w h = 1e-3.
TEST(Body, DampingTakesWhatHuntAndCrossleySay) {
  const double c = 0.3, v0 = 1;
  const Body plane(Plane{}, {}, {.stiffness = stiffness, .damping = c});
  FreePoints point(straight(1, 0.3, per_length, 0), {&plane});
  point.points.v = {0, 0, -v0};
  const double w = std::sqrt(stiffness / per_length);
  point.run(4 / w, 4000);
  const double v1 = point.velocity(0).z;
  EXPECT_GT(v1, 0.5);
  EXPECT_GT(point.place(0).z, 0);
  // The right side changes with v_1 by c^2 v_1/(1 - c v_1), below c^2 2.
  EXPECT_NEAR(-c * v1 - std::log(1 - c * v1), c * v0 - std::log(1 + c * v0),
              2 * c * c * 1e-6);
}

TEST(Body, NeverPullsAndKeepsToTheFrictionCone) {
  const double mu = 0.6;
  const Body sphere(Sphere{0.8}, {},
                    {.stiffness = 50, .damping = 0.7, .friction = mu, .slip = 0.2});
  const Cloud cloud(400);
  const auto f = load(sphere, 0, cloud.points());
  int touching = 0;
  for (std::size_t i = 0; i < cloud.count(); ++i) {
    const Vec x = load3(&cloud.x[3 * i]), force = load3(&f[3 * i]);
    const bool inside = norm(x) < 0.8;
    if (!inside) {
      EXPECT_EQ(norm(force), 0);
      continue;
    }
    ++touching;
    const Vec n = (1 / norm(x)) * x;
    const double normal = dot(n, force);
    EXPECT_GE(normal, 0);
    EXPECT_LE(norm(force - normal * n), mu * normal + 50 * 8 * eps);
    EXPECT_LE(dot(force - normal * n, load3(&cloud.v[3 * i])), 50 * 8 * eps);
  }
  EXPECT_GT(touching, 50);
}

TEST(Body, LoadDoesNotDependOnTheNumberOfPoints) {
  const Body plane(Plane{}, {}, {.stiffness = stiffness, .friction = 0.4});
  const auto total = [&](std::size_t n) {
    Cloud strand = straight(n, 0.3, per_length, -2e-3);
    for (std::size_t i = 0; i < n; ++i) store3(Vec{1, 1, 0}, &strand.v[3 * i]);
    const auto f = load(plane, 0, strand.points());
    Vec sum;
    for (std::size_t i = 0; i < n; ++i) sum = sum + load3(&f[3 * i]);
    return sum;
  };
  EXPECT_LE(norm(total(40) - total(5)), 40 * eps * norm(total(5)));
  EXPECT_NEAR(total(5).z, stiffness * 2e-3 * 0.3, 8 * eps);
}

RootMotion shaking_head() {
  RootMotion head;
  head.position = {0.1, -0.2, 1.5};
  head.frame = rotation({0, 0, 1}, 0.4);
  head.centre = Vec{0, 0, 1.4};
  head.rotations = {{{1, 2, 0.5}, sine(0.5, 1.5)}};
  head.translations = {{{0, 0, 1}, sine(0.2, 1)}};
  return head;
}

// dx/dt = v and de_k/dt = omega x e_k by differences: h^2/6 times third derivatives below
// a (3 pi)^3 4 with amplitudes a < 0.5 (rotations compound), h = 1e-5; rounding 4 eps/h.
TEST(Body, FollowsTheHead) {
  const RootMotion head = shaking_head();
  const StrandPlace place{{0.05, 0.1, 1.45}, rotation({0, 1, 0}, 0.3)};
  const Body body(Sphere{0.1}, place, {.stiffness = 1}, head);
  const double h = 1e-5, bound = h * h / 6 * 0.5 * 837 * 4 + 4 * eps / h;
  EXPECT_LE(norm(body.pose(0).x - place.x), 4 * eps);
  EXPECT_LE(norm(body.pose(0).frame.e1 - place.frame.e1), 8 * eps);
  for (const double t : {0.1, 0.37, 2.0}) {
    const BodyPose before = body.pose(t - h), now = body.pose(t),
                   after = body.pose(t + h);
    EXPECT_LE(norm(1 / (2 * h) * (after.x - before.x) - now.v), bound);
    const Vec turns = 1 / (2 * h) * (after.frame.e2 - before.frame.e2);
    EXPECT_LE(norm(turns - cross(now.omega, now.frame.e2)), bound);
    // It keeps its place in the head.
    const RootPose there = head.at(t);
    const Vec arm = there.frame.back(now.x - there.x);
    EXPECT_LE(norm(arm - head.frame.back(place.x - head.position)), 16 * eps);
  }
}

TEST(Body, OnlyPushesWhatMovesWithIt) {
  const Body body(Sphere{0.3}, {{0.05, 0.1, 1.45}, {}},
                  {.stiffness = 50, .damping = 2, .friction = 0.8, .slip = 1e-2},
                  shaking_head());
  const double t = 0.37;
  const BodyPose pose = body.pose(t);
  Cloud one(1);
  const Vec normal{0.6, 0, 0.8}, x = pose.x + 0.28 * normal;
  store3(x, one.x.data());
  store3(pose.surface_velocity(x), one.v.data());
  const Vec f = load3(load(body, t, one.points()).data());
  const double expected = 50 * 0.02 * one.length[0];
  EXPECT_LE(norm(f - expected * normal), 50 * 64 * eps);
  // The motion of the body does all of the work.
  EXPECT_NEAR(body.power(t, one.points()), dot(f, pose.surface_velocity(x)), 1e-12);
}

TEST(Body, TellsTheDeepestPoint) {
  const Body sphere(Sphere{0.5}, {{0, 0, 1}, {}}, {.stiffness = 1, .offset = 0.01});
  EXPECT_EQ(*sphere.penetration(0, std::vector{0.0, 0.0, 0.0, 2.0, 0.0, 1.0}), 0);
  EXPECT_NEAR(*sphere.penetration(0, std::vector{0.0, 0.0, 0.55, 0.3, 0.0, 1.0}), 0.21,
              4 * eps);
}

TEST(Body, IsDrawnWhereItIs) {
  const StrandPlace place{{0.05, 0.1, 1.45}, rotation({0, 1, 0}, 0.3)};
  const Body body(Capsule{0.1, 0.2}, place, {.stiffness = 1}, shaking_head());
  const BodyPose pose = body.pose(0.37);
  const std::optional<Outline> drawn = body.outline(0.37);
  ASSERT_TRUE(drawn.has_value());
  EXPECT_EQ(drawn->shape, "capsule");
  EXPECT_EQ(norm(drawn->half_axes - Vec{0.1, 0.1, 0.2}), 0);
  EXPECT_EQ(norm(drawn->x - pose.x), 0);
  EXPECT_EQ(norm(drawn->frame.e2 - pose.frame.e2), 0);
}

TEST(Effect, HasNoDepthAndNoOutlineUnlessItIsABody) {
  EXPECT_FALSE(gravity.penetration(0, std::vector{0.0, 0.0, -1.0}));
  EXPECT_FALSE(gravity.outline(0));
  const Body grid(DistanceGrid(sphere_samples(0.6, 1, 81), "test"), {}, {.stiffness = 1});
  EXPECT_FALSE(grid.outline(0)) << "a grid is not drawn";
}

TEST(Body, ASampledSphereActsAsASphere) {
  const BodyContact law{.stiffness = 50, .friction = 0.5};
  const Body exact(Sphere{0.6}, {}, law);
  const Body sampled(DistanceGrid(sphere_samples(0.6, 1, 81), "test"), {}, law);
  Cloud one(1);
  one.x = {0.35, 0.3, 0.33};
  const Vec a = load3(load(exact, 0, one.points()).data());
  const Vec b = load3(load(sampled, 0, one.points()).data());
  // k l times the error of d g: that of g is O(h^2 phi''') = 0.025^2 3/0.56^2 = 6e-3 of
  // the load, that of phi O(h^3 phi'''') = 0.025^3 15/0.56^3 = 1.3e-3 m, both with the
  // factors of the interpolation (1/6 and below) left out.
  EXPECT_LE(norm(a - b), 6e-3 * norm(a) + 50 * one.length[0] * 1.3e-3);
  EXPECT_GT(norm(a), 0);
}

TEST(Body, RefusesWhatHasNoMeaning) {
  const BodyContact law{.stiffness = 1};
  EXPECT_THROW(Body(Sphere{0}, {}, law), InputError);
  EXPECT_THROW(Body(Ellipsoid({1, 0, 1}), {}, law), InputError);
  EXPECT_THROW(Body(Capsule{1, -1}, {}, law), InputError);
  EXPECT_THROW(Body(Plane{}, {}, {.stiffness = -1}), InputError);
  EXPECT_THROW(Body(Plane{}, {}, {.slip = 0}), InputError);
  EXPECT_THROW(Body(Plane{}, {{}, {{2, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, law), InputError);
  // The surface is 0.1 from the second layer, the spacing 0.1.
  EXPECT_THROW(Body(DistanceGrid(sphere_samples(0.8, 1, 21), "test"), {}, law),
               InputError);
  Parameters none(body_parameters(), "test");
  none.set("shape", "sdf");
  EXPECT_THROW(make_body(none, {}), InputError);
}

}  // namespace tress::test_body
