// What a scene does not name is not computed: what strand models ready for an effect is
// what it asks for, and nothing when there is none.
#include <gtest/gtest.h>

#include "integrators/catalogue.h"
#include "models/catalogue.h"
#include "models/strand/strand.h"
#include "simulation/run/simulation.h"
#include "tests/support/tested.h"

namespace tress::test_effect_cost {

using namespace simulation;

struct Seen {
  int calls = 0;
  bool position = false, velocity = false, tangent = false;
  int derivatives = 0, directions = 0;
};

/// Pushes nothing and keeps count of what it is given.
class Spy final : public Effect {
 public:
  Spy(Needs needs, Seen& seen) : needs_(needs), seen_(seen) {}
  std::string_view name() const override { return "spy"; }
  Needs needs() const override { return needs_; }
  void add_load(double, const Points& p, InOut) const noexcept override {
    ++seen_.calls;
    seen_.position = seen_.position || !p.x.empty();
    seen_.velocity = seen_.velocity || !p.v.empty();
    seen_.tangent = seen_.tangent || !p.tangent.empty();
  }
  void add_derivatives(double, const Points&, double, double,
                       InOut) const noexcept override {
    ++seen_.derivatives;
  }
  void add_direction_derivatives(double, const Points&, double,
                                 InOut) const noexcept override {
    ++seen_.directions;
  }
  double potential(double, const Points&) const noexcept override { return 0; }
  double power(double, const Points&) const noexcept override { return 0; }

 private:
  Needs needs_;
  Seen& seen_;
};

class EffectCost : public testing::TestWithParam<const ModelEntry*> {
 protected:
  std::unique_ptr<System> system(Effects effects) {
    const Strand strand =
        make_strand({}, {}, {.elements = 5, .length = 0.1}, uniform_shape({}));
    const Parameters options(GetParam()->parameters, "model");
    return GetParam()->on_strand(strand, options, std::move(effects));
  }
  /// What a residual and a linearization read for an effect of these needs.
  Seen seen(Needs needs) {
    Seen counts;
    Effects effects;
    effects.push_back(std::make_unique<Spy>(needs, counts));
    const auto watched = system(std::move(effects));
    const State s = initial_state(*watched);
    std::vector<double> a(s.q.size()), r(s.q.size());
    EXPECT_EQ(watched->residual(0, s.q, s.v, a, r), Status::ok);
    EXPECT_EQ(watched->linearize(0, s.q, s.v, a, {1, 1e-3, 1e-6}), Status::ok);
    return counts;
  }
};

TEST_P(EffectCost, OnlyWhatIsAskedForIsComputed) {
  const Seen nothing = seen({});
  EXPECT_GT(nothing.calls, 0);
  EXPECT_FALSE(nothing.velocity) << "velocities without a velocity-dependent effect";
  EXPECT_FALSE(nothing.tangent);
  EXPECT_EQ(nothing.derivatives, 0);
  EXPECT_FALSE(nothing.position);
  EXPECT_FALSE(seen({.position = true}).velocity);
  EXPECT_TRUE(seen({.position = true}).position);
  EXPECT_TRUE(seen({.velocity = true}).velocity);
  EXPECT_TRUE(seen({.tangent = true}).tangent);
  const Needs turning{.velocity = true, .tangent = true, .derivatives = true};
  EXPECT_EQ(seen(turning).directions, 0) << "nobody asked what turning does";
  Needs directed = turning;
  directed.directions = true;
  EXPECT_GT(seen(directed).directions, 0);
}

/// The strand without effects is the one whose effect does nothing, bit by bit.
TEST_P(EffectCost, NoEffectIsNoTerm) {
  Seen counts;
  Effects effects;
  effects.push_back(std::make_unique<Spy>(
      Needs{.position = true, .velocity = true, .tangent = true}, counts));
  const auto bare = system({}), watched = system(std::move(effects));
  const State s = initial_state(*bare);
  std::vector<double> a(s.q.size(), 1.0), r(s.q.size()), expected(s.q.size());
  ASSERT_EQ(bare->residual(0, s.q, s.v, a, r), Status::ok);
  ASSERT_EQ(watched->residual(0, s.q, s.v, a, expected), Status::ok);
  EXPECT_EQ(r, expected);
}

std::vector<const ModelEntry*> on_strands() {
  std::vector<const ModelEntry*> all;
  for (const ModelEntry& entry : testing_support::tested_models()) {
    if (entry.on_strand != nullptr) all.push_back(&entry);
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Catalogue, EffectCost, testing::ValuesIn(on_strands()),
                         [](const auto& tested) {
                           return std::string(tested.param->id);
                         });

}  // namespace tress::test_effect_cost
