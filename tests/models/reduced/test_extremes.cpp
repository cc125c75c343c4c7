#include <gtest/gtest.h>

#include <numbers>

#include "contract/forms/energetics.h"
#include "contract/forms/explicit_form.h"
#include "math/frame.h"
#include "tests/models/reduced/static_equilibrium.h"

namespace tress::test_extremes {

using namespace simulation;

using namespace testing_support;
using std::numbers::pi;

std::vector<double> solved(System& system, const States& s, const std::vector<double>& q,
                           Weights w, const std::vector<double>& b) {
  std::vector<double> x = b;
  EXPECT_EQ(system.linearize(t0, q, s.v, s.a, w), Status::ok);
  EXPECT_EQ(system.solve(b, x), Status::ok);
  return x;
}

class ZeroCurvature : public testing::TestWithParam<StrandCase> {};

TEST_P(ZeroCurvature, IsPassedThroughSmoothly) {
  const auto system = GetParam().make({{"elements", "6"}, {"motion", "shake"}});
  States s(*system, 17);
  s.shake(0);  // q = 0, v and a random: gyroscopic terms are alive
  const std::vector<double> zero = zeros(*system);
  const std::vector<double> d = s.random(std::vector<double>(s.n, 1.0));
  const std::vector<double> at_zero = residual(*system, zero, s.v, s.a);
  const std::vector<double> slope = tangent_product(*system, s, {0, 0, 1}, d);
  const std::vector<double> b = s.random(at_zero);
  for (const double size : {1e-300, 1e-12, 1e-4, -1e-4}) {  // 1/m, or rad
    const std::vector<double> q = plus(zero, size, d);
    // r(0) + size slope, up to the next order, L size = 1e-5 of the change at most with
    // L = 0.1 m, to the difference behind `slope`, and to rounding.
    const std::vector<double> r = residual(*system, q, s.v, s.a);
    const std::vector<double> line = plus(at_zero, size, slope);
    EXPECT_LE(largest(plus(r, -1, line)),
              (std::abs(size) + tangent_tolerance) * std::abs(size) * largest(slope) +
                  100 * eps * largest(at_zero))
        << size;
    for (const Weights w : {Weights{1, 1e-2, 1e-4}, Weights{1, 0, 0}, Weights{0, 0, 1}}) {
      // Solutions move by the change of S, L size, times its condition, 1e6 at most.
      const std::vector<double> straight = solved(*system, s, zero, w, b);
      const std::vector<double> curved = solved(*system, s, q, w, b);
      EXPECT_LE(relative_difference(curved, straight, s.a_typ),
                1e6 * (0.1 * std::abs(size) + eps))
          << size << ", " << w.acc << " " << w.vel << " " << w.pos;
    }
  }
}

std::vector<StrandCase> straight_strands() {
  std::vector<StrandCase> all;
  for (const std::string model : {"super_helix", "articulated_chain"}) {
    for (const std::string modes : {"bend_twist", "bend", "bend_planar"}) {
      all.push_back({model + "_" + modes, find_model(model).id, {{"modes", modes}}});
    }
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Reduced, ZeroCurvature, testing::ValuesIn(straight_strands()),
                         [](const auto& tested) { return tested.param.name; });

/// Where a helix of length l and Darboux vector kappa, |kappa| > 0, ends: the part along
/// the axis goes on, the part across turns.
Vec helix_tip(const Vec& kappa, double l) {
  const double w = norm(kappa);
  const Vec axis = 1 / w * kappa, tangent{1, 0, 0};
  const Vec along = dot(axis, tangent) * axis, across = tangent - along;
  return l * along + std::sin(w * l) / w * across +
         (1 - std::cos(w * l)) / w * cross(axis, across);
}

struct Winding {
  const char* modes;
  Vec direction;  // of the Darboux vector
};

class ManyTurns : public testing::TestWithParam<Winding> {
 protected:
  /// Three elements that each wind by `angle`, at rest in that shape.
  std::unique_ptr<System> wound(double angle) const {
    const Vec kappa = angle / element_m * GetParam().direction;
    return make_model("super_helix", {{"modes", GetParam().modes},
                                      {"elements", "3"},
                                      {"length_m", text(3 * element_m)},
                                      {"natural_twist_per_m", text(kappa.x)},
                                      {"natural_curvature_per_m", text(kappa.y)},
                                      {"natural_curvature2_per_m", text(kappa.z)}});
  }
  static constexpr double element_m = 0.03;  // m
  static constexpr double angles[] = {pi / 2, 2 * pi, 3.7 * pi, 6 * pi};
};

TEST_P(ManyTurns, EndWhereHelicesEnd) {
  for (const double angle : angles) {
    const auto system = wound(angle);
    const State start = initial_state(*system);
    const std::vector<double> x = points({wound(angle), start.q});
    const Vec kappa = angle / element_m * GetParam().direction;
    const Vec step = helix_tip(kappa, element_m);
    const Frame turn = rotation(GetParam().direction, angle);
    Frame frame;  // root_tangent x: the axes of space
    Vec tip;
    for (std::size_t i = 0; i < 3; ++i) {
      tip = tip + frame * step;
      frame = frame * turn;
      const Vec off = load3(&x[3 * (i + 1)]) - tip;
      // Sines of up to 6 pi round by 6 pi eps; some ten such terms an element.
      EXPECT_LE(norm(off), 10 * 6 * pi * eps * 3 * element_m) << angle;
    }
  }
}

// At rest the residual is the gradient of the potential energy, which is a sum over
// points and knows no lever arms, frames or recursions.
TEST_P(ManyTurns, HangByTheGradientOfTheirEnergy) {
  for (const double angle : angles) {
    const auto system = wound(angle);
    States s(*system, 3);
    s.shake(0.3);
    const std::vector<double> zero = zeros(*system);
    const std::vector<double> d = s.random(s.q_typ);
    const auto potential = [&](double e) {
      return std::vector<double>{
          system->energetics()->energy(t0, plus(s.q, e, d), zero).potential};
    };
    const std::vector<double> r = residual(*system, s.q, zero, zero);
    double power = 0, size = 0;
    for (std::size_t i = 0; i < s.n; ++i) {
      power += r[i] * d[i];
      size += std::abs(r[i] * d[i]);
    }
    // Rounding eps/e = 3e-13 of the energy, which is here ten times the work, and
    // truncation as much.
    EXPECT_NEAR(central_difference(difference_step, potential)[0], power, 1e-10 * size)
        << angle;
  }
}

TEST_P(ManyTurns, HaveTheTangentOfTheirResidual) {
  for (const double angle : angles) {
    const auto system = wound(angle);
    States s(*system, 3);
    for (const Weights w : {Weights{1, 1e-3, 1e-6}, Weights{1, 0.1, 0.01}}) {
      s.shake(0.05);
      EXPECT_LE(tangent_error(*system, *system, s, w), tangent_tolerance) << angle;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Reduced, ManyTurns,
                         testing::Values(Winding{"bend_twist", {0.6, 0.64, 0.48}},
                                         Winding{"bend_twist", {0.28, 0, 0.96}},
                                         Winding{"bend", {0.6, 0.64, 0.48}},
                                         Winding{"bend_planar", {0, 1, 0}}));

struct Size {
  const char *elements, *radius, *youngs_modulus;
};

void PrintTo(const Size& size, std::ostream* out) {
  *out << size.elements << " elements, " << size.radius << " m, " << size.youngs_modulus
       << " Pa";
}

class Sizes : public testing::TestWithParam<Size> {
 protected:
  ModelSettings settings(const std::string& modes) const {
    return {{"modes", modes},
            {"elements", GetParam().elements},
            {"radius_m", GetParam().radius},
            {"youngs_modulus_pa", GetParam().youngs_modulus}};
  }
};

TEST_P(Sizes, HaveTheTangentOfTheirResidual) {
  for (const std::string model : {"super_helix", "articulated_chain"}) {
    for (const std::string modes : {"bend_twist", "bend", "bend_planar"}) {
      const auto system = make_model(model, settings(modes));
      States s(*system);
      s.shake(0.05);
      for (const Weights w : {Weights{1, 1e-3, 1e-6}, Weights{1, 0.1, 0.01}}) {
        EXPECT_LE(tangent_error(*system, *system, s, w), tangent_tolerance)
            << model << ", " << modes;
      }
    }
  }
}

TEST_P(Sizes, AcceleratesAndSteps) {
  for (const std::string model : {"super_helix", "articulated_chain"}) {
    for (const std::string modes : {"bend_twist", "bend", "bend_planar"}) {
      SCOPED_TRACE(model + ", " + modes);
      const auto system = make_model(model, settings(modes));
      const State start = initial_state(*system);
      std::vector<double> a = zeros(*system), r = a;
      ASSERT_EQ(system->explicit_form()->acceleration(0, start.q, start.v, a),
                Status::ok);
      const std::vector<double> load =
          residual(*system, start.q, start.v, zeros(*system));
      r = residual(*system, start.q, start.v, a);
      // The solve for a is backward stable: n rounding errors of the load.
      EXPECT_LE(largest(r), 100 * static_cast<double>(r.size()) * eps * largest(load));
      for (const std::string integrator : {"linearly_implicit_euler", "backward_euler"}) {
        Options options;
        options.step = 1e-3;
        const Simulation run = simulate(integrator, *system, options, start, 5e-3);
        EXPECT_EQ(run.status, Status::ok) << integrator << ": " << run.failure;
        EXPECT_TRUE(std::isfinite(largest(run.state.q) + largest(run.state.v)));
      }
    }
  }
}

std::vector<Size> sizes() {
  std::vector<Size> all;
  for (const char* elements : {"1", "20", "500"}) {
    for (const char* radius : {"20e-6", "1e-3"}) {
      for (const char* youngs_modulus : {"1e6", "1e10"}) {
        all.push_back({elements, radius, youngs_modulus});
      }
    }
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Reduced, Sizes, testing::ValuesIn(sizes()));

}  // namespace tress::test_extremes
