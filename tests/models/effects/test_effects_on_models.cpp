#include <gtest/gtest.h>

#include "contract/forms/energetics.h"
#include "integrators/formulation/dynamics.h"
#include "models/effects/air_drag.h"
#include "models/effects/body.h"
#include "models/effects/catalogue.h"
#include "models/effects/tether.h"
#include "models/strand/strand_parameters.h"
#include "tests/support/tangent.h"

// Every model of a strand under effects that depend on place, velocity and time: the
// blocks of the effects must arrive in the tangent, their power and potential in the
// energy.
namespace tress::test_effects_on_models {

using namespace integrators;
using namespace models;

using namespace testing_support;

/// Sizes in proportion to a hair of 0.1 m, whose weight is 6e-6 N. All points stay in
/// contact and below the slip speed, so that every load is smooth.
Effects smooth_effects() {
  Effects effects;
  effects.push_back(std::make_unique<AirDrag<LinearAirLaw, Gusts>>(
      "wind", LinearAirLaw{2e-5}, Gusts({1, 0.3, 0}, 0.8, 0.2, 0.4, 3)));
  effects.push_back(std::make_unique<Body>(
      Ellipsoid({9, 11, 10}), StrandPlace{{0, 0, -9}, {}},
      BodyContact{.stiffness = 1e-4, .damping = 1e-3, .friction = 0.3, .slip = 1e4}));
  effects.push_back(
      std::make_unique<Tether>(Tether::Settings{.at = 0.7,
                                                .stiffness = 1e-4,
                                                .damping = 1e-6,
                                                .pull = 1e-6,
                                                .soft = 0.05,
                                                .target = {0.05, 0.02, 0.03},
                                                .amplitude = {0, 0.01, 0},
                                                .frequency = 2,
                                                .on = -1,
                                                .off = 1}));
  return effects;
}

/// All where plug-ins bring an effect.
std::vector<const ModelEntry*> strand_models() {
  std::vector<const ModelEntry*> all;
  const bool every = !added_effects().empty();
  for (const ModelEntry& entry : every ? model_catalogue() : tested_models()) {
    if (entry.on_strand != nullptr) all.push_back(&entry);
  }
  return all;
}

/// Soft, so that elastic forces do not drown those of the effects.
Parameters soft(const ModelEntry& model) {
  Parameters parameters(setup_parameters(model), "test");
  parameters.set("elements", "5");
  parameters.set("youngs_modulus_pa", "1e4");
  return parameters;
}

class EffectsOnModels : public testing::TestWithParam<const ModelEntry*> {
 protected:
  std::unique_ptr<System> make() const {
    const Parameters parameters = soft(*GetParam());
    return GetParam()->on_strand(strand(parameters), parameters, smooth_effects());
  }
};

INSTANTIATE_TEST_SUITE_P(Catalogue, EffectsOnModels, testing::ValuesIn(strand_models()),
                         [](const auto& one) { return std::string(one.param->id); });

TEST_P(EffectsOnModels, TheTangentHoldsTheirDerivatives) {
  const auto system = make();
  if (!system->traits().regular_mass) GTEST_SKIP() << "S is singular on its own";
  States s(*system);
  for (const Weights w :
       {Weights{1, 0.1, 0.01}, Weights{1, 0.05, 0}, Weights{400, 20, 1}}) {
    s.shake(0.05);
    EXPECT_LE(tangent_error(*system, *system, s, w), tangent_tolerance)
        << "weights " << w.acc << " " << w.vel << " " << w.pos;
  }
}

/// An effect whose tangent has lost a part that its load has.
class Forgetful final : public Effect {
 public:
  enum class Lost { nothing, directions, all };
  Forgetful(std::shared_ptr<const Effect> whole, Lost lost)
      : whole_(std::move(whole)), lost_(lost) {}
  std::string_view name() const override { return whole_->name(); }
  Needs needs() const override {
    Needs needs = whole_->needs();
    needs.derivatives = needs.derivatives && lost_ != Lost::all;
    needs.directions = needs.directions && lost_ == Lost::nothing;
    return needs;
  }
  void add_load(double t, const Points& p, InOut f) const noexcept override {
    whole_->add_load(t, p, f);
  }
  void add_derivatives(double t, const Points& p, double pos, double vel,
                       InOut blocks) const noexcept override {
    if (lost_ != Lost::all) whole_->add_derivatives(t, p, pos, vel, blocks);
  }
  void add_direction_derivatives(double t, const Points& p, double factor,
                                 InOut blocks) const noexcept override {
    if (lost_ == Lost::nothing) whole_->add_direction_derivatives(t, p, factor, blocks);
  }
  double potential(double t, const Points& p) const noexcept override {
    return whole_->potential(t, p);
  }
  double power(double t, const Points& p) const noexcept override {
    return whole_->power(t, p);
  }

 private:
  std::shared_ptr<const Effect> whole_;
  Lost lost_;
};

/// Air that a strand of radius 2 mm and C_t = 1 feels from all sides: what turning the
/// tangent does to the load is a good part of it.
Effects kinds_of_effects() {
  Effects kinds = smooth_effects();
  const AnisotropicAirLaw<SquareDrag> square{{1.2 * 1.2 * 2e-3}, 1.2 * 3.14 * 2e-3};
  const AnisotropicAirLaw<CylinderDrag> cylinder{{9e-6, 2 * 2e-3 * 1.2 / 1.8e-5}, 7e-3};
  kinds.push_back(std::make_shared<AirDrag<AnisotropicAirLaw<SquareDrag>, StillAir>>(
      "quadratic_drag", square, StillAir{}));
  kinds.push_back(std::make_shared<AirDrag<AnisotropicAirLaw<CylinderDrag>, Gusts>>(
      "wind_quadratic", cylinder, Gusts({0.5, 0.3, -0.2}, 0.4, 0.2, 0.4, 3)));
  for (const EffectEntry& effect : added_effects()) {
    kinds.push_back(effect.make(Parameters(effect.parameters, "test"), {}));
  }
  return kinds;
}

/// S x - b for the x that solves it, b the image of a random vector; what the differences
/// themselves may be off; both at once for an effect and for one that forgets.
struct TangentGap {
  double off, bound;
};
TangentGap tangent_gap(System& tangent_of, System& residual_of, const States& s,
                       Weights w, const std::vector<double>& y) {
  const auto image = [&](const std::vector<double>& x, double over) {
    return tangent_product(residual_of, s, w, x, over);
  };
  // Off by O(e^4): the whole of it, twice, is between a step and half of it.
  const auto bound = [&](const std::vector<double>& x) {
    constexpr double h = difference_step;
    return 2 * largest(plus(image(x, h), -1, image(x, h / 2))) +
           2 * tangent_rounding(residual_of, s, w, x);
  };
  const std::vector<double> b = image(y, difference_step / 2);
  std::vector<double> x(s.n);
  EXPECT_EQ(tangent_of.linearize(t0, s.q, s.v, s.a, w), Status::ok);
  EXPECT_EQ(tangent_of.solve(b, x), Status::ok);
  // solve() leaves roundoffs of sums over n entries that cancel, three digits at most.
  const double solved = 1e3 * 2.2e-16 * static_cast<double>(s.n) * largest(b);
  return {largest(plus(image(x, difference_step / 2), -1, b)),
          bound(x) + bound(y) + solved};
}

/// Every effect by itself: its whole derivative is in the tangent, to what the quotient
/// of differences may be off, which could not hide a part of it.
void expect_exact_effects(const ModelEntry& model, const Parameters& parameters) {
  using Lost = Forgetful::Lost;
  for (const auto& effect : kinds_of_effects()) {
    SCOPED_TRACE(std::string(effect->name()));
    const auto with = [&](Lost lost) {
      return model.on_strand(strand(parameters), parameters,
                             {std::make_shared<Forgetful>(effect, lost)});
    };
    const auto system = with(Lost::nothing);
    if (!system->traits().regular_mass) return;
    States s(*system);
    s.shake(0.05);
    const Weights w{1, 0.1, 0.01};
    const std::vector<double> y = s.random(s.a_typ);
    const TangentGap whole = tangent_gap(*system, *system, s, w, y);
    EXPECT_LE(whole.off, whole.bound);
    for (const Lost lost : {Lost::directions, Lost::all}) {
      if (lost == Lost::directions && !effect->needs().directions) continue;
      // A dead load has no derivative to lose.
      if (!effect->needs().derivatives && !effect->needs().directions) continue;
      const TangentGap gap = tangent_gap(*with(lost), *system, s, w, y);
      EXPECT_GT(gap.off, 10 * gap.bound) << "the check sees nothing";
    }
  }
}

TEST_P(EffectsOnModels, TheTangentIsExactForEveryEffect) {
  expect_exact_effects(*GetParam(), soft(*GetParam()));
}

// A turning clamp adds terms to a tangent whose unknowns turn in a plane only, or do not
// twist: every choice of unknowns with every motion of the root.
TEST_P(EffectsOnModels, TheTangentIsExactForAllUnknownsAndMotionsOfTheRoot) {
  const auto choices = [&](std::string_view key) {
    for (const Parameter& p : setup_parameters(*GetParam())) {
      if (p.name == key) return words_of(p.choices);
    }
    return std::vector<std::string_view>{};
  };
  for (const std::string_view modes : choices("modes")) {
    for (const std::string_view root : choices("motion")) {
      if (root == "free" && modes == "bend_planar") continue;  // refused: it is spatial
      SCOPED_TRACE(std::string(modes) + " " + std::string(root));
      Parameters parameters = soft(*GetParam());
      parameters.set("modes", std::string(modes));
      parameters.set("motion", std::string(root));
      // All of the head's motion is on at t0, and about no axis of the strand.
      expect_exact_effects(*GetParam(), parameters);
    }
  }
}

/// The accelerations that follow from q and v where no constraint has a say; else those
/// of `s`, any.
void accelerate(System& system, States& s) {
  if (s.m > 0) return;
  Dynamics dynamics(system, {});
  ASSERT_EQ(dynamics.accelerate(t0, s.q, s.v, s.a, {}), Status::ok);
}

// Along a motion q' = v, v' = a of a strand with its root at rest, the energy changes by
// the power and by v.r, where r is what the forces lack for a (0 when a follows from
// them). Errors as in the contract test of energy (tests/contracts): e^4 and eps/e of
// E/time, two digits of margin.
TEST_P(EffectsOnModels, TheEnergyHoldsTheirPotentialAndPower) {
  const auto system = make();
  Energetics* energetics = system->energetics();
  if (energetics == nullptr) GTEST_SKIP() << "no energetics";
  States s(*system);
  if (s.m == 0 && !system->traits().regular_mass)
    GTEST_SKIP() << "no acceleration follows from q and v alone";
  s.shake(0.05);
  accelerate(*system, s);
  const double time =
      std::min(largest(s.q_typ) / largest(s.v), largest(s.v) / largest(s.a));
  const auto energy = [&](double e) {
    const auto q = plus(plus(s.q, e, s.v), e * e / 2, s.a);
    return std::vector{energetics->energy(t0 + e, q, plus(s.v, e, s.a)).total()};
  };
  const double rate = central_difference(difference_step * time, energy)[0];
  double expected = energetics->power(t0, s.q, s.v), work = 0;
  if (s.m > 0) {
    const auto r = residual(*system, s.q, s.v, s.a);
    for (std::size_t i = 0; i < s.n; ++i) {
      expected += s.v[i] * r[i];
      work += std::abs(s.v[i] * r[i]);
    }
  }
  const Energy now = energetics->energy(t0, s.q, s.v);
  const double scale = std::abs(now.kinetic) + std::abs(now.potential);
  EXPECT_NEAR(rate, expected, 1e-10 * (scale / time + work));
}

}  // namespace tress::test_effects_on_models
