#include <gtest/gtest.h>

#include "models/effects/self_contact.h"
#include "models/strand/strand_parameters.h"
#include "tests/models/reduced/strand_cases.h"

// The tangent of a strand that touches itself, where loads depend on distant points.
namespace tress::test_self_touch {

using namespace simulation;

using namespace testing_support;

struct Spiral {
  std::string model;
  ModelSettings settings;
  /// Of the contact, N/m^2: as much as the model's own stiffness shows.
  double stiffness;
  bool kinked = false;  // with a mount between segments
};

void PrintTo(const Spiral& s, std::ostream* out) {
  *out << s.model;
  for (const auto& [key, value] : s.settings) *out << ", " << value;
  if (s.kinked) *out << ", kinked";
}

/// Turns of 10 cm narrow from a radius of 10 mm to 4 mm and lie some 2 mm apart, within
/// reach.
std::unique_ptr<System> spiral_of(const Spiral& of, bool touches = true,
                                  bool curled = true) {
  const Parameters parameters =
      parameters_of(of.model, with({{"elements", "16"}}, of.settings));
  Strand s = strand(parameters);
  const bool planar =
      parameters.knows("modes") && parameters.word("modes") != "bend_twist";
  for (std::size_t i = 0; i < s.segments.size(); ++i) {
    const double along = static_cast<double>(i) / 16;
    s.segments[i].natural = {planar ? 0.0 : 20, 100 + 150 * along, 0};
    s.segments[i].initial = curled ? s.segments[i].natural : Vec{};
    if (of.kinked && i == 7) s.segments[i].mount = rotation({0.6, 0, 0.8}, 0.3);
  }
  const double stiffness = touches ? of.stiffness : 0;
  Effects effects = strand_effects(parameters);
  effects.push_back(
      std::make_shared<SelfContact>(ContactLaw({.stiffness = stiffness,
                                                .viscosity = 1e-3 * stiffness,
                                                .inner = 3e-3,
                                                .outer = 5e-3},
                                               "test"),
                                    1.2e-2));
  return find_model(of.model).on_strand(s, parameters, effects);
}

class SelfTouch : public testing::TestWithParam<Spiral> {
 protected:
  static std::unique_ptr<System> spiral(bool touches = true, bool curled = true) {
    return spiral_of(GetParam(), touches, curled);
  }
};

// Of the system's scales: 0.01 mm of places, so that samples stay on their edges and
// within reach. Rounding, which grows as eps over it, would be 1e-7 at a tenth of it.
constexpr double short_step = 1e-4;

TEST_P(SelfTouch, HasTheTangentOfItsResidual) {
  const auto system = spiral(), alone = spiral(false);
  States s(*system, 3);
  for (const Weights w : {Weights{1, 1e-3, 1e-6}, Weights{1, 0.1, 0.01}}) {
    s.shake(0.01);
    EXPECT_LE(tangent_error(*system, *system, s, w, short_step), tangent_tolerance);
    if (w.pos < 1e-3) continue;
    EXPECT_GE(tangent_error(*alone, *system, s, w, short_step), 0.01);
  }
}

// Across the gap a repulsion helps what leaves the line of both, by force/gap: the stiff
// tangent leaves that out, or it would have no Cholesky factor.
TEST(StiffSelfTouch, IsDefiniteHoweverStrongTheContactIs) {
  for (const char* solver : {"recursive", "composite"}) {
    for (const double stiffness : {10.0, 1e3, 1e6}) {
      const Spiral of{
          "super_helix", {{"jacobian", "elastic"}, {"solver", solver}}, stiffness};
      const auto system = spiral_of(of);
      States s(*system, 3);
      s.shake(0.01);
      for (const double h : {1e-3, 1e-2, 0.1}) {
        EXPECT_EQ(system->linearize(t0, s.q, s.v, s.a, {1, h, h * h}), Status::ok)
            << solver << ", " << stiffness << " N/m^2, " << h << " s";
      }
    }
  }
}

// Without contacts the chosen method goes on, and comes back after some.
TEST_P(SelfTouch, ContactsComeAndGo) {
  const auto system = spiral(), alone = spiral(false);
  const Weights w{1, 0.1, 0.01};
  States coiled(*system, 3);
  coiled.shake(0.01);
  const States straight(*spiral(true, false), 3);
  const std::vector<double> b = coiled.random(coiled.a_typ);
  const auto solution = [&](System& of, const States& at) {
    std::vector<double> x(b.size());
    EXPECT_EQ(of.linearize(t0, at.q, at.v, at.a, w), Status::ok);
    EXPECT_EQ(of.solve(b, x), Status::ok);
    return x;
  };
  const std::vector<double> first = solution(*system, coiled);
  EXPECT_NE(first, solution(*alone, coiled));
  EXPECT_EQ(solution(*system, straight), solution(*alone, straight));
  EXPECT_EQ(first, solution(*system, coiled));
}

INSTANTIATE_TEST_SUITE_P(
    Models, SelfTouch,
    testing::Values(
        Spiral{"super_helix", {{"motion", "shake_rotate"}}, 10},
        Spiral{"super_helix", {{"motion", "free"}}, 10},
        Spiral{"super_helix", {{"motion", "shake_rotate"}}, 10, true},
        Spiral{"super_helix", {{"modes", "bend"}, {"motion", "shake_rotate"}}, 10},
        Spiral{"super_helix", {{"modes", "bend_planar"}}, 10},
        Spiral{"super_helix", {{"modes", "bend_planar"}, {"motion", "shake_rotate"}}, 10},
        Spiral{"super_clothoid", {{"motion", "shake_rotate"}}, 10},
        Spiral{"super_clothoid", {{"modes", "bend"}, {"motion", "free"}}, 10},
        Spiral{"articulated_chain", {{"motion", "shake_rotate"}}, 10},
        Spiral{"force_transport", {{"motion", "shake_rotate"}}, 10},
        Spiral{"der", {{"motion", "shake_rotate"}}, 1e6},
        Spiral{"der", {{"motion", "free"}}, 1e6},
        Spiral{"corde", {{"motion", "shake_rotate"}}, 1e6},
        Spiral{"xpbd_cosserat", {{"motion", "shake_rotate"}}, 1e6},
        Spiral{"dynamic_spline", {{"motion", "shake_rotate"}}, 1e6},
        Spiral{"mass_spring", {{"motion", "shake_rotate"}}, 1e6}));

}  // namespace tress::test_self_touch
