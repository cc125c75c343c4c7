#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "integrators/bdf2_formula.h"
#include "integrators/catalogue.h"
#include "integrators/fixed_step.h"
#include "integrators/gradient/step_memory.h"
#include "integrators/stage/stage.h"
#include "simulation/gradient/linearized_step.h"
#include "simulation/gradient/scene_gradient.h"
#include "simulation/scene/scene.h"
#include "tests/support/refusal.h"

/// Gradients with methods that a contributor adds.
namespace tress::test_added_methods {

using namespace integrators;

using testing::HasSubstr;
using testing_support::refusal;

enum class Keeps { nothing, the_step_before, the_step_before_unseen, a_span_of_three };

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
    const bool two =
        (keeps == Keeps::the_step_before || keeps == Keeps::the_step_before_unseen) &&
        h_previous_ > 0;
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

/// Backward Euler with a loop of its own.
class OwnLoop final : public Integrator {
 public:
  OwnLoop(System& system, const Options& options) : euler_(system, options) {}

  Status start(double t, In q, In v) override { return euler_.start(t, q, v); }
  Status advance(double t_end, const Observer& each_step) override {
    return euler_.advance(t_end, each_step);
  }
  double time() const override { return euler_.time(); }
  In q() const override { return euler_.q(); }
  In v() const override { return euler_.v(); }
  Stats stats() const override { return euler_.stats(); }
  std::string failure() const override { return euler_.failure(); }
  Limit limit() const override { return euler_.limit(); }

 private:
  Added<Keeps::nothing> euler_;
};

/// Backward Euler's prediction, without a Stage.
class Unseen final : public FixedStep {
 public:
  using FixedStep::FixedStep;

 private:
  Status step(double /*t*/, double h) override {
    for (std::size_t i = 0; i < q_.size(); ++i) q_[i] += h * v_[i];
    return Status::ok;
  }
};

template <class Method>
void add(std::string_view id) {
  add_integrator({.id = id,
                  .summary = "added",
                  .source = "this test",
                  .tangent = true,
                  .stages = 1,
                  .formulations = of_order(1, stage_formulations),
                  .make = make_method<Method>},
                 "this test");
}

class AddedMethods : public testing::Test {
 protected:
  // Before anything reads the catalogue, which closes it.
  static void SetUpTestSuite() {
    add<Added<Keeps::nothing>>("added_step");
    add<Added<Keeps::the_step_before>>("added_two_steps");
    add<Added<Keeps::the_step_before_unseen>>("added_unseen_step");
    add<Added<Keeps::a_span_of_three>>("added_span");
    add<OwnLoop>("added_loop");
    add<Unseen>("added_unseen_stages");
  }
};

TEST_F(AddedMethods, RememberStepsAsBuiltInOnesIfTheirFormulaDoes) {
  const std::set<std::string_view> remember{"bdf2", "generalized_alpha",
                                            "added_two_steps", "added_unseen_step"};
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

/// Scene of a strand with a gradient by this method.
simulation::Scene scene_with_gradient(const std::string& method, const std::string& way) {
  return simulation::parse_scene(
      "title = \"t\"\nduration_s = 0.02\n[integrator]\nid = \"" + method +
          "\"\ndt_s = 0.002\n[material]\n[strand]\nelements = 2\n[root]\n"
          "[effects.gravity]\n[gradient]\nby = [\"density_kg_m3\", "
          "\"natural_curvature_per_m.each\", \"natural_twist_per_m.each\", "
          "\"natural_curvature2_per_m.each\", \"initial_curvature_per_m.each\", "
          "\"initial_twist_per_m.each\"]\nof = \"last_tip\"\nway = \"" +
          way + "\"\n",
      "s.toml");
}

TEST_F(AddedMethods, AreRefusedByTheAdjointIfItCannotTransposeThem) {
  const std::pair<std::string, std::string> reasons[] = {
      {"added_span", "state() of added_span has a span of 3 numbers"},
      {"added_unseen_step",
       "depends on numbers that its state() and numbers() leave out"},
      {"added_loop", "added_loop is no FixedStep"}};
  for (const auto& [method, reason] : reasons) {
    SCOPED_TRACE(method);
    EXPECT_THAT(no_transposed_steps(method, {}), HasSubstr(reason));
    const auto scene = scene_with_gradient(method, "adjoint");
    EXPECT_THAT(refusal([&] { simulation::check_gradient(scene); }), HasSubstr(reason));
    EXPECT_THAT(refusal([&] { simulation::scene_gradient(scene); }), HasSubstr(reason));
  }
}

// With more parameters than automatic gradients take forward.
TEST_F(AddedMethods, HaveTheAdjointOfTheirFormulaOrAreTakenForward) {
  for (const char* method : {"added_step", "added_two_steps", "added_loop", "added_span",
                             "added_unseen_step"}) {
    SCOPED_TRACE(method);
    const bool transposed = no_transposed_steps(method, {}).empty();
    EXPECT_EQ(transposed, std::string(method) == "added_step" ||
                              std::string(method) == "added_two_steps");
    const auto scene = scene_with_gradient(method, "auto");
    EXPECT_NO_THROW(simulation::check_gradient(scene));
    const auto found = simulation::scene_gradient(scene).strands.front();
    EXPECT_EQ(found.unfinished, "");
    EXPECT_EQ(found.adjoint, transposed);
    const auto forward =
        simulation::scene_gradient(scene_with_gradient(method, "forward"))
            .strands.front();
    for (std::size_t k = 0; k < forward.by.size(); ++k) {
      for (std::size_t c = 1; c <= 3; ++c) {
        const double expected = *(forward.by[k].back().end() - c);
        EXPECT_NEAR(*(found.by[k].back().end() - c), expected,
                    1e-7 * std::abs(expected) + 1e-12)
            << k;
      }
    }
  }
}

TEST_F(AddedMethods, AreRefusedIfTheyDoNotShowTheirStages) {
  for (const char* way : {"auto", "forward", "adjoint"}) {
    const auto scene = scene_with_gradient("added_unseen_stages", way);
    EXPECT_THAT(refusal([&] { simulation::check_gradient(scene); }),
                HasSubstr("does not show the solutions of its stages"));
  }
}

TEST_F(AddedMethods, BuiltInStatesAreAllThatTheNextStepDependsOn) {
  std::set<std::string_view> start;
  for (const IntegratorEntry& entry : integrator_catalogue()) {
    if (entry.stages == 0 || entry.id.starts_with("added_")) continue;
    EXPECT_EQ(no_transposed_steps(entry.id, {}), "") << entry.id;
    EXPECT_TRUE(shows_stages(entry.id)) << entry.id;
    if (starts_from_accelerations(entry.id)) start.insert(entry.id);
  }
  EXPECT_EQ(start, (std::set<std::string_view>{"esdirk43", "generalized_alpha", "newmark",
                                               "tr_bdf2"}));
}

}  // namespace tress::test_added_methods
