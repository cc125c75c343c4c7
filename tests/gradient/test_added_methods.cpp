#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "integrators/bdf2_formula.h"
#include "integrators/catalogue.h"
#include "integrators/fixed_step.h"
#include "integrators/gradient/step_memory.h"
#include "integrators/gradient/step_probe.h"
#include "integrators/stage/stage.h"
#include "simulation/gradient/linearized_step.h"
#include "simulation/scene/scene.h"
#include "tests/support/refusal.h"

/// Gradients with methods that a contributor adds.
namespace tress::test_added_methods {

using namespace integrators;

using testing::HasSubstr;
using testing_support::refusal;

enum class Keeps { nothing, the_step_before, a_span_of_three };

/// Bdf2Formula, or backward Euler by methods that do not keep the step before.
template <Keeps keeps>
class Added final : public FixedStep {
 public:
  Added(System& system, const Options& options)
      : FixedStep(system, options),
        stage_(dynamics_, options),
        q_bar_(vector_n()),
        v_bar_(vector_n()),
        q_previous_(vector_n()),
        v_previous_(vector_n()),
        three_(3) {}

  std::vector<InOut> state() override {
    std::vector<InOut> all{q_, v_};
    if (keeps == Keeps::the_step_before) {
      all.insert(all.end(), {q_previous_, v_previous_});
    }
    if (keeps == Keeps::a_span_of_three) all.emplace_back(three_);
    return all;
  }
  std::vector<double*> numbers() override {
    if (keeps == Keeps::the_step_before) return {&h_previous_};
    return {};
  }

 private:
  Status reset(double /*t*/) override {
    h_previous_ = 0;
    return Status::ok;
  }

  Status step(double t, double h) override {
    const bool two = keeps == Keeps::the_step_before && h_previous_ > 0;
    const auto [c0, c1, bh] = Bdf2Formula(h, two ? h / h_previous_ : 0);
    for (std::size_t i = 0; i < q_.size(); ++i) {
      v_bar_[i] = c0 * v_[i] - c1 * v_previous_[i];
      q_bar_[i] = c0 * q_[i] - c1 * q_previous_[i] + bh * v_bar_[i];
    }
    q_previous_ = q_;
    v_previous_ = v_;
    h_previous_ = h;
    stage_.leave(t, q_);
    const Status s = stage_.solve(t + h, q_bar_, v_bar_, {1, bh, bh * bh}, a_, lambda_);
    take(stage_.q(), stage_.v());
    return s;
  }

  Stage stage_;
  double h_previous_ = 0;
  std::vector<double> q_bar_, v_bar_, q_previous_, v_previous_, three_;
};

template <Keeps keeps>
void add(std::string_view id) {
  add_integrator({.id = id,
                  .summary = "added",
                  .source = "this test",
                  .tangent = true,
                  .stages = 1,
                  .formulations = of_order(1, stage_formulations),
                  .make = make_method<Added<keeps>>},
                 "this test");
}

class AddedMethods : public testing::Test {
 protected:
  // Before anything reads the catalogue, which closes it.
  static void SetUpTestSuite() {
    add<Keeps::nothing>("added_step");
    add<Keeps::the_step_before>("added_two_steps");
    add<Keeps::a_span_of_three>("added_span");
  }
};

TEST_F(AddedMethods, RememberStepsAsBuiltInOnesIfTheirFormulaDoes) {
  const std::set<std::string_view> remember{"bdf2", "generalized_alpha",
                                            "added_two_steps"};
  std::set<std::string_view> found;
  for (const IntegratorEntry& entry : integrator_catalogue()) {
    if (entry.stages > 0 && remembers_steps(entry.id)) found.insert(entry.id);
  }
  EXPECT_EQ(found, remember);
}

TEST_F(AddedMethods, AreRefusedByTheLinearizedStepIfTheyRememberSteps) {
  const auto linearized = [](const std::string& method) {
    const simulation::Scene scene = simulation::parse_scene(
        "title = \"t\"\nduration_s = 0.02\n[integrator]\nid = \"" + method +
            "\"\ndt_s = 0.002\n[material]\n[strand]\nelements = 2\n[root]\n"
            "[effects.gravity]\n",
        "s.toml");
    return simulation::linearized_step(scene, 0, 0.004, 0.002, {});
  };
  EXPECT_EQ(linearized("added_step").unfinished, "");
  const std::string refused = refusal([&] { linearized("added_two_steps"); });
  EXPECT_THAT(refused,
              HasSubstr("a step of added_two_steps depends on the steps before"));
  // The remedy names methods that do not.
  EXPECT_THAT(refused, HasSubstr("added_step"));
  EXPECT_EQ(refused.find("added_two_steps", refused.find("use one of")), refused.npos);
}

TEST_F(AddedMethods, AreRefusedByTheAdjointIfTheirStateHasOtherSpans) {
  EXPECT_NO_THROW(StepProbe("added_two_steps", {}));
  EXPECT_THAT([] { StepProbe("added_span", {}); },
              testing::ThrowsMessage<std::logic_error>(
                  HasSubstr("state() of added_span has a span of 3 numbers")));
}

}  // namespace tress::test_added_methods
