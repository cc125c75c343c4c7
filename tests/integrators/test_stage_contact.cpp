// Strands that fall into a cone of three planes: ends hit head-on, and all that is in
// contact may stick or slip. Where Newton's method with a penalty finds no solution,
// state and forces are found at once.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "contract/forms/contact_form.h"
#include "contract/input_error.h"
#include "integrators/catalogue.h"
#include "models/catalogue.h"
#include "models/effects/exact_body.h"
#include "models/effects/gravity.h"
#include "models/strand/strand.h"
#include "tests/support/bare_system.h"

namespace tress::test_stage_contact {
namespace {

using namespace models;

constexpr double radius = 40e-6, length = 0.1, depth = 0.03, g = 9.81;

/// The system with contact by multipliers and penalties alone.
class ByPenalties final : public testing_support::BareSystem, private ContactForm {
 public:
  explicit ByPenalties(System& original)
      : BareSystem(original), form_(*original.contact_form()) {}
  ContactForm* contact_form() override { return this; }

 private:
  std::size_t tracked() const override { return form_.tracked(); }
  void places(double t, In q, In v, Out x) noexcept override { form_.places(t, q, v, x); }
  void slides(double t, In q, In v, Out u) noexcept override { form_.slides(t, q, v, u); }
  void begin(double t, double tau, In q0, In v0, In x0) noexcept override {
    form_.begin(t, tau, q0, v0, x0);
  }
  double improve(double t, In q, In v) noexcept override {
    return form_.improve(t, q, v);
  }
  double drive() const noexcept override { return form_.drive(); }
  void extrapolate() noexcept override { form_.extrapolate(); }
  double approach(double t, In q, In v) noexcept override {
    return form_.approach(t, q, v);
  }
  void release() noexcept override { form_.release(); }
  bool rebounds() const override { return form_.rebounds(); }
  std::vector<double> multipliers() const override { return form_.multipliers(); }
  void set_multipliers(In values) override { form_.set_multipliers(values); }

  ContactForm& form_;
};

std::unique_ptr<System> above_cone(const std::string& id, double turn) {
  Strand strand = make_strand({}, {radius, radius}, {.elements = 10, .length = length},
                              uniform_shape({}));
  strand.free_root = FreeRoot{};
  Effects effects{std::make_shared<Gravity>(Vec{0, 0, -g})};
  const Vec apex{length / 2, 0, -depth};
  for (int side = 0; side < 3; ++side) {
    const double around = turn + side * 2 * std::numbers::pi / 3;
    const Vec level{-std::sin(around), std::cos(around), 0};
    effects.push_back(std::make_shared<ExactBody>(
        Plane{}, StrandPlace{apex, rotation(level, -std::numbers::pi / 4)},
        ExactContact{{.offset = radius}, true, 0.5}));
  }
  const ModelEntry& model = find_model(id);
  return model.on_strand(strand, Parameters(model.parameters, "test"), effects);
}

/// A helix has more contacts there than unknowns: some steps keep the laws to 1e-6 m/s.
double tolerance_of(const std::string& id) {
  return id == "super_helix" ? 1e-6 : Options{}.contact_tolerance;
}

Stats fall(System& system, double contact_tolerance) {
  Options options;
  options.step = 1.0 / 300;
  options.contact_tolerance = contact_tolerance;
  const auto method = integrators::make_integrator("backward_euler", system, options);
  const auto n = static_cast<std::size_t>(system.layout().coordinates);
  std::vector<double> q(n), v(n);
  system.initial_state(q, v);
  EXPECT_EQ(method->start(0, q, v), Status::ok);
  EXPECT_EQ(method->advance(45 * options.step), Status::ok) << method->failure();
  return method->stats();
}

class FallIntoCone : public testing::TestWithParam<std::string> {};

// The steps that Newton's method with a penalty does not solve take most of all
// iterations: a few per step with the forces at once, hundreds without. The courses are
// not the same, for after the impact the smallest differences grow; so several falls are
// counted.
TEST_P(FallIntoCone, TakesFewerIterationsWithItsForces) {
  long with_forces = 0, by_penalties = 0;
  for (const double turn : {0.0, 0.2, 0.4, 0.6}) {
    const auto one = above_cone(GetParam(), turn), other = above_cone(GetParam(), turn);
    const double tolerance = tolerance_of(GetParam());
    const Stats first = fall(*one, tolerance);
    ByPenalties alone(*other);
    const Stats second = fall(alone, tolerance);
    with_forces += first.newton_iterations;
    by_penalties += second.newton_iterations;
    EXPECT_LE(first.contact_violation, 1e-6) << turn;
  }
  EXPECT_LT(3 * with_forces, 2 * by_penalties);
}

// Impacts make velocities jump, and a multistep formula would carry the jump on.
TEST(Bdf2, HasNoErrorControlWithExactContact) {
  const auto system = above_cone("der", 0);
  Options options;
  options.contact_tolerance = tolerance_of("der");
  EXPECT_NO_THROW(integrators::make_integrator("bdf2", *system, options));
  options.tolerance = 1e-3;
  EXPECT_NO_THROW(integrators::make_integrator("tr_bdf2", *system, options));
  EXPECT_THROW(integrators::make_integrator("bdf2", *system, options), InputError);
}

INSTANTIATE_TEST_SUITE_P(Models, FallIntoCone,
                         testing::Values("der", "corde", "xpbd_cosserat", "super_helix",
                                         "articulated_chain"),
                         [](const auto& of) { return of.param; });

}  // namespace
}  // namespace tress::test_stage_contact
