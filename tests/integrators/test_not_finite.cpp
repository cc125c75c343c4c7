#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "experiments/problems/formulations.h"
#include "experiments/problems/strand_models.h"
#include "models/catalogue.h"
#include "models/effects/gravity.h"
#include "models/strand/strand_parameters.h"
#include "simulation/run/simulation.h"

// Where numbers stop being finite is named: which term, which place, which step.
namespace tress::test_not_finite {

using namespace experiments;

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// No load but at one point from some time on, where it is not a number.
class Poison final : public Effect {
 public:
  Poison(std::size_t point, double from) : point_(point), from_(from) {}
  std::string_view name() const override { return "poison"; }
  Needs needs() const override { return {}; }
  void add_load(double t, const Points&, InOut f) const noexcept override {
    if (t >= from_) f[3 * point_] = nan;
  }
  void add_derivatives(double, const Points&, double, double,
                       InOut) const noexcept override {}
  double potential(double, const Points&) const noexcept override { return 0; }
  double power(double, const Points&) const noexcept override { return 0; }

 private:
  std::size_t point_;
  double from_;
};

constexpr double step = 1e-3;        // s
constexpr double poisoned = 0.0202;  // s: after 20 whole steps, before the middle of 21

class NotFinite : public testing::TestWithParam<const ModelEntry*> {
 protected:
  /// Falls under gravity.
  std::unique_ptr<System> make(double poisoned_from) const {
    Parameters parameters(setup_parameters(*GetParam()), "test");
    parameters.set("elements", "5");
    Effects effects = strand_effects(parameters);
    effects.push_back(std::make_shared<Poison>(3, poisoned_from));
    return GetParam()->on_strand(strand(parameters), parameters, std::move(effects));
  }

  static std::string failure(std::string_view integrator, System& system,
                             const State& start) {
    const auto formulations = usable_formulations(find_integrator(integrator), system);
    if (formulations.empty()) return {};
    Options options;
    options.step = step;
    options.formulation = formulations.front();
    const Simulation run = simulate(integrator, system, options, start, 0.05);
    EXPECT_NE(run.status, Status::ok) << integrator;
    return run.failure;
  }
};

INSTANTIATE_TEST_SUITE_P(Models, NotFinite, testing::ValuesIn(strand_models()),
                         [](const auto& one) { return std::string(one.param->id); });

TEST_P(NotFinite, IsNothingWhileAllIsFinite) {
  const auto system = make(1);
  const State start = initial_state(*system);
  EXPECT_THAT(system->not_finite(0, start.q, start.v), IsEmpty());
}

TEST_P(NotFinite, OfAnEffectNamesItAndThePoint) {
  const auto system = make(0.5);
  const State start = initial_state(*system);
  EXPECT_THAT(system->not_finite(0.4, start.q, start.v), IsEmpty());
  EXPECT_EQ(system->not_finite(0.5, start.q, start.v), "poison at point 3");
}

// Fixed steps of 1 ms find it in the 21st, whatever part of the step they look at.
TEST_P(NotFinite, OfAnEffectIsInTheFailureWithTheStepAndItsTime) {
  for (const std::string_view integrator :
       {"linearly_implicit_euler", "backward_euler", "implicit_midpoint", "bdf2",
        "generalized_alpha"}) {
    const auto system = make(poisoned);
    EXPECT_THAT(failure(integrator, *system, initial_state(*system)),
                AllOf(HasSubstr("poison at point 3"), HasSubstr("step 21"),
                      HasSubstr("t = 0.02 s")))
        << integrator;
  }
}

// Adaptive steps are their own, the words are the same.
TEST_P(NotFinite, OfAnEffectIsInTheFailureOfTheLibraries) {
  for (const std::string_view integrator : {"cvode_bdf", "ida"}) {
    const auto system = make(poisoned);
    const std::string words = failure(integrator, *system, initial_state(*system));
    if (words.empty()) continue;  // refused
    EXPECT_THAT(words, AllOf(HasSubstr("poison at point 3"), HasSubstr("step")))
        << integrator;
  }
}

TEST(NotFiniteByGsl, OfAnEffectIsInTheFailure) {
  Strand hair = make_strand({}, {}, {.elements = 2}, uniform_shape({}));
  Parameters parameters(setup_parameters(find_model("der")), "test");
  const auto system = find_model("der").on_strand(
      hair, parameters, {std::make_shared<Poison>(2, poisoned)});
  const Simulation run = simulate("gsl_rkf45", *system, {}, initial_state(*system), 0.05);
  EXPECT_THAT(run.failure, AllOf(HasSubstr("poison at point 2"), HasSubstr("step")));
}

TEST_P(NotFinite, OfACoordinateNamesItsPlace) {
  const auto system = make(1);
  for (const bool rates : {false, true}) {
    State start = initial_state(*system);
    // The third group of three, or six: element or control point 2, node 3 beside a
    // clamped one.
    const std::size_t group = GetParam()->id == "super_clothoid" ? 6 : 3;
    (rates ? start.v : start.q)[2 * group + 1] = nan;
    const auto place =
        testing::AnyOf(HasSubstr("element 2"), HasSubstr("node 2"), HasSubstr("node 3"));
    EXPECT_THAT(system->not_finite(0, start.q, start.v),
                AllOf(HasSubstr(rates ? "rates of " : "coordinates of "), place));
    // A step has made a coordinate of the rate.
    EXPECT_THAT(failure("backward_euler", *system, start),
                AllOf(place, HasSubstr("step 1")));
  }
}

// Curvatures, angles and lengths of 1e200 are finite, their squares are not.
TEST_P(NotFinite, OfAnElasticOrInertialTermIsNoEffect) {
  const auto system = make(1);
  State start = initial_state(*system);
  for (double& x : start.q) x *= 1e200;
  for (double& x : start.v) x = 1e200;
  // Bending by the directions of edges alone stays finite.
  const bool by_directions = GetParam()->id == "inextensible_strand";
  const std::vector<double> rest(start.q.size());
  std::vector<double> r(start.q.size());
  EXPECT_EQ(system->residual(0, start.q, start.v, rest, r) == Status::ok, by_directions);
  EXPECT_THAT(
      system->not_finite(0, start.q, start.v),
      testing::Matcher<std::string>(
          by_directions ? testing::Matcher<std::string>(testing::IsEmpty())
                        : testing::Matcher<std::string>(HasSubstr("elasticity"))));
}

}  // namespace tress::test_not_finite
