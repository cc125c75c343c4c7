// A ring through which a strand slides: its place, its tangent in models, its work, and a
// bar that flies through it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "models/effects/ring.h"
#include "models/motion/signals.h"
#include "tests/models/reduced/work_of_motion.h"
#include "tests/support/apart.h"
#include "tests/support/refusal.h"
#include "tests/support/small_motion.h"

namespace tress::test_ring {

using namespace testing_support;

std::shared_ptr<const Ring> ring(Vec place, double stiffness, double damping = 0,
                                 Vec way = {}, double time = 1) {
  Ring::Settings settings{stiffness, damping, {}};
  settings.path.position = place;
  if (norm(way) > 0)
    settings.path.translations.push_back({way, rests({0, time}, {0, 1})});
  return std::make_shared<Ring>(settings);
}

std::unique_ptr<System> with_ring(const std::string& model, const ModelSettings& settings,
                                  std::shared_ptr<const Ring> ring) {
  const Parameters parameters = parameters_of(model, settings);
  return find_model(model).on_strand(strand(parameters), parameters, {std::move(ring)});
}

/// Points on a quarter of a circle of radius 1 m.
struct Arc {
  explicit Arc(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      const double h = std::numbers::pi / 2 / double(count - 1), angle = double(i) * h;
      for (const double entry : {std::sin(angle), 0.0, std::cos(angle)})
        x.push_back(entry);
      arc.push_back(angle);
      length.push_back(i == 0 || i + 1 == count ? h / 2 : h);
    }
  }
  Points points() const {
    Points p;
    p.count = int(arc.size());
    p.x = x;
    p.length = length;
    p.arc = arc;
    p.longest = arc.back();
    return p;
  }
  std::vector<double> x, arc, length;
};

/// On a circle the closest place has the angle of the ring. Cubic interpolation errs by
/// h^4/24 of the fourth derivative in the last interval: 1.6e-6 in the place with 20
/// intervals, and in its derivative, which s* follows, by some 1e-5.
TEST(Ring, HoldsTheClosestPlaceAcrossTheStrand) {
  const Arc strand(21);
  for (const double angle : {0.02, 0.4, 0.8, 1.1, 1.55}) {
    for (const double radius : {0.9, 1.0, 1.2}) {
      const auto held = ring({radius * std::sin(angle), 0, radius * std::cos(angle)}, 2);
      const Ring::Inside in = held->inside(0, strand.points());
      EXPECT_NEAR(in.s, angle, 3e-5);
      EXPECT_NEAR(norm(in.d), std::abs(radius - 1), 2e-6);
      EXPECT_LE(std::abs(dot(in.d, in.tangent)), 1e-12);
      double sum = 0;
      for (std::size_t j = 0; j < in.count; ++j) sum += in.weight[j];
      EXPECT_NEAR(sum, 1, 1e-14);
    }
  }
  // Beyond the tip, the end stays in the ring.
  const Ring::Inside end = ring({2, 0, -1}, 2)->inside(0, strand.points());
  EXPECT_TRUE(end.at_end);
  EXPECT_NEAR(end.s, std::numbers::pi / 2, 1e-14);
}

/// df/dx of the load, (3 count x 3 count) row-major, by couplings.
std::vector<double> by_places(const Ring& held, const Points& p) {
  std::vector<Coupling> all;
  held.add_couplings(0, p, all);
  const std::size_t n = p.x.size();
  std::vector<double> found(n * n);
  for (const Coupling& coupling : all) {
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t c = 0; c < 4; ++c) {
        double block[9] = {};
        coupling.add_block(a, c, 1, 0, block);
        const std::size_t row = 3 * coupling.ends[a].point,
                          column = 3 * coupling.ends[c].point;
        for (std::size_t i = 0; i < 9; ++i) {
          found[(row + i / 3) * n + column + i % 3] += block[i];
        }
      }
    }
  }
  return found;
}

/// Rounding of loads of 1 N over 1e-6 m is 1e-9 of derivatives of 1 N/m and more, the
/// truncation 1e-12 of the third derivatives.
TEST(Ring, CouplingsAreTheWholeDerivativeOfTheLoad) {
  // Across the strand between two points, next to the tip and beyond it, and outside of
  // the point in the middle.
  const double diagonal = 1.25 * std::numbers::sqrt2 / 2;
  const std::pair<std::size_t, Vec> all[] = {{21, {0.75, 0.06, 0.72}},
                                             {21, {1.02, 0.1, 0.03}},
                                             {21, {1.2, 0.1, -0.3}},
                                             {5, {diagonal, 0.1, diagonal}}};
  for (const auto& [count, place] : all) {
    Arc strand(count);
    std::vector<double> v(strand.x.size());
    for (std::size_t i = 0; i < v.size(); ++i) v[i] = std::sin(1.7 * double(i) + 0.4);
    std::vector<double> of_spring;
    for (const double damping : {0.0, 3.0}) {
      const auto held = ring(place, 2, damping, {0.2, 0.1, -0.3});
      const auto load = [&] {
        Points p = strand.points();
        p.v = v;
        std::vector<double> f(v.size());
        held->add_load(0, p, f);
        return f;
      };
      Points p = strand.points();
      p.v = v;
      const std::vector<double> found = by_places(*held, p);
      double worst = 0, most = 0;
      for (std::size_t j = 0; j < v.size(); ++j) {
        const double x = strand.x[j];
        const auto d = central_difference(1e-6, [&](double e) {
          strand.x[j] = x + e;
          return load();
        });
        strand.x[j] = x;
        for (std::size_t i = 0; i < v.size(); ++i) {
          worst = std::max(worst, std::abs(found[i * v.size() + j] - d[i]));
          most = std::max(most, std::abs(d[i]));
        }
      }
      EXPECT_LT(worst, 1e-7 * most) << place.x << " " << damping;
      if (damping == 0) {
        of_spring = found;
        continue;
      }
      // What the damper adds is there to be seen, but not of a held end.
      EXPECT_EQ(held->inside(0, p).at_point, count == 5);
      const bool at_end = held->inside(0, p).at_end;
      EXPECT_EQ(at_end, place.z < 0);
      EXPECT_EQ(apart(found, of_spring) > 0.1 * most, !at_end);
    }
  }
}

const ModelSettings soft{{"elements", "6"},
                         {"radius_m", "1e-3"},
                         {"youngs_modulus_pa", "1e4"},
                         {"natural_curvature_per_m", "15"}};

class RingOnModels : public testing::TestWithParam<std::string> {};

/// The motion of the place along the strand is part of the tangent, with a damper too.
TEST_P(RingOnModels, HasItsDerivativesInTheTangent) {
  const auto alone = make_model(GetParam(), soft);
  States at_start(*alone);
  MaterialPoints& points = *alone->material_points();
  std::vector<double> x(3 * std::size_t(points.count()));
  points.positions(0, at_start.q, x);
  const Vec place = load3(&x[9]) + Vec{0.004, 0.003, 0.002};
  for (const double damping : {0.0, 1e-3}) {
    const auto system = with_ring(GetParam(), soft, ring(place, 1e-2, damping));
    States s(*system);
    s.shake(0.02);
    for (const Weights w :
         {Weights{1, 0.1, 0.01}, Weights{1, 0.05, 0}, Weights{400, 20, 1}}) {
      const double off = tangent_error(*system, *system, s, w);
      std::printf("%s: %.1e\n", GetParam().c_str(), off);
      EXPECT_LE(off, tangent_tolerance) << damping;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Models, RingOnModels,
                         testing::Values("super_helix", "super_clothoid",
                                         "articulated_chain", "der", "mass_spring",
                                         "corde"));

/// A ring at a small height h holds a clamped beam at x = a with the force 3 E I h/a^3,
/// in series with the ring, 1e4 times as stiff. Models of order 2 err by 1e-3 with 40
/// elements.
TEST(Ring, BendsACantileverWhereItHoldsIt) {
  const double modulus = 3e9, radius = 1e-4, length = 0.1, h = 1e-5;
  const double bending = modulus * std::numbers::pi / 4 * std::pow(radius, 4);
  for (const char* model : {"super_helix", "super_clothoid", "der"}) {
    for (const double a : {0.0512, 0.08}) {
      const double soft_as = 3 * bending / std::pow(a, 3), stiffness = 1e4 * soft_as;
      const auto held = ring({a, 0, h}, stiffness);
      const auto system = with_ring(model,
                                    {{"elements", "40"},
                                     {"length_m", std::to_string(length)},
                                     {"radius_m", "1e-4"},
                                     {"youngs_modulus_pa", "3e9"},
                                     {"gravity_m_s2", "0"}},
                                    held);
      Start start(*system);
      settle(*system, 0, 8, start.q);
      const double energy = system->energetics()->energy(0, start.q, start.v).potential;
      // Of beam and ring in series, half the force times the height.
      const double expected = soft_as / (1 + 1e-4) * h * h / 2;
      std::printf("%s at %g: energy off by %.1e\n", model, a, energy / expected - 1);
      EXPECT_NEAR(energy / expected, 1, 3e-3) << model;
    }
  }
}

/// A stiff bar flies through a ring along itself: nothing holds it back. Rounding of d
/// and of the rates is 1e-12 of the way.
TEST(Ring, LetsABarFlyThrough) {
  for (const char* model : {"super_helix", "super_clothoid"}) {
    const ModelSettings settings{{"elements", "5"},    {"motion", "free"},
                                 {"radius_m", "1e-3"}, {"youngs_modulus_pa", "1e9"},
                                 {"spin_rad_s", "0"},  {"speed_m_s", "0"},
                                 {"gravity_m_s2", "0"}};
    auto system = with_ring(model, settings, ring({0.03, 0, 0}, 10));
    State start = initial_state(*system);
    MaterialPoints& points = *system->material_points();
    std::vector<double> x(3 * std::size_t(points.count()));
    points.positions(0, start.q, x);
    const double tip = x[x.size() - 3];
    start.v[start.v.size() - 6] = 0.2;  // of a free root, along x
    Options options;
    options.step = 1e-3;
    const Simulation run = simulate("tr_bdf2", *system, options, start, 0.1, {});
    ASSERT_EQ(run.status, Status::ok) << run.failure;
    points.positions(0.1, run.state.q, x);
    EXPECT_NEAR(x[x.size() - 3], tip + 0.02, 1e-12) << model;
    EXPECT_NEAR(x[x.size() - 1], 0, 1e-12) << model;
  }
}

/// A ring that moves gives its work to the strand; its damper takes energy.
TEST(Ring, GivesItsWorkToTheStrand) {
  for (const char* model : {"super_helix", "der"}) {
    for (const double damping : {0.0, 1e-4}) {
      const double order = order_of_work(
          model,
          [&] {
            return with_ring(
                model,
                {{"elements", "5"}, {"radius_m", "1e-3"}, {"youngs_modulus_pa", "1e6"}},
                ring({0.043, 0, 0}, 1, damping, {0.01, 0.01, 0.02}, 0.05));
          },
          {0.4e-3, 0.2e-3, 0.1e-3});
      EXPECT_NEAR(order, 2, 0.3) << model << " " << damping;
    }
  }
}

TEST(Ring, RefusesWhatIsNoRing) {
  EXPECT_NE(refusal([] { ring({}, 0); }).find("give stiffness_n_per_m > 0"),
            std::string::npos);
  EXPECT_NE(refusal([] { ring({}, 1, -1); }).find("damping_n_s_per_m >= 0"),
            std::string::npos);
}

}  // namespace tress::test_ring
