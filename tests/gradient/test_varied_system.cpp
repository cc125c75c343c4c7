#include <gtest/gtest.h>

#include "tests/gradient/strand_runs.h"

namespace tress::test_varied_system {

using namespace testing_support;

StrandRun helix() {
  StrandRun run{&find_model("super_helix"), {}, {}, {}, {}};
  run.settings = {{"elements", "3"},
                  {"initial", "straight"},
                  {"natural_curvature_per_m", "10"},
                  {"motion", "shake_rotate"},
                  {"drag_kg_m_s", "1e-4"},
                  {"internal_friction_kg_m3_s", "1e-9"}};
  return run;
}

/// By steps of a hundredth: the quadrature of a helix depends on its natural curvature.
VariedSystem varied(const std::string& key, double value) {
  const StrandRun run = helix();
  const auto system = run.make();
  return varied_system(*system, run.parameter({key, value, 0.01 * value}));
}

// Moduli, internal friction and natural strains enter each equation by its own unknown,
// drag and density by all.
TEST(VariedSystem, IsSimpleWhereAParameterEntersEntryByEntry) {
  for (const auto& [key, value] : {std::pair("youngs_modulus_pa", 3e9),
                                   {"internal_friction_kg_m3_s", 1e-9},
                                   {"natural_curvature_per_m", 10.0}}) {
    const VariedSystem one = varied(key, value);
    EXPECT_TRUE(one.simple.has_value()) << key;
    EXPECT_EQ(one.systems.size(), 1u) << key;
  }
  for (const auto& [key, value] :
       {std::pair("drag_kg_m_s", 1e-4), {"density_kg_m3", 1300.0}}) {
    const VariedSystem one = varied(key, value);
    EXPECT_FALSE(one.simple.has_value()) << key;
    EXPECT_EQ(one.systems.size(), 1u) << key;
  }
  EXPECT_EQ(varied("radius_m", 4e-5).systems.size(), 4u);
}

/// A spring of stiffness 1 + s that acts beyond q = 5 only.
class FarSpring final : public System {
 public:
  explicit FarSpring(double s) : stiffness_(1 + s) {}
  Layout layout() const override { return {1, 0}; }
  Traits traits() const override { return {true, true}; }
  void initial_state(Out q, Out v) const override { q[0] = v[0] = 0; }
  void scale(Out q_typ, Out v_typ) const override { q_typ[0] = v_typ[0] = 1; }
  Status residual(double, In q, In, In a, Out r) noexcept override {
    r[0] = a[0] + (q[0] > 5 ? stiffness_ * (q[0] - 5) : 0);
    return Status::ok;
  }
  Status linearize(double, In, In, In, Weights) noexcept override { return Status::ok; }
  Status solve(In, Out) noexcept override { return Status::ok; }

 private:
  double stiffness_;
};

// What a contact's stiffness does is not seen before something touches.
TEST(VariedSystem, IsNotSimpleWhereAParameterDoesNotActYet) {
  FarSpring system(0);
  const VariedSystem one =
      varied_system(system, [](double s) { return std::make_unique<FarSpring>(s); });
  EXPECT_FALSE(one.simple.has_value());
  EXPECT_EQ(one.systems.size(), 4u);  // nor is it believed to be affine
}

/// A spring of stiffness 1 + s whose force has a term s^2 beyond q = 5.
class TurningSpring final : public System {
 public:
  explicit TurningSpring(double s) : s_(s) {}
  Layout layout() const override { return {1, 0}; }
  Traits traits() const override { return {true, true}; }
  void initial_state(Out q, Out v) const override { q[0] = v[0] = 1; }
  void scale(Out q_typ, Out v_typ) const override { q_typ[0] = v_typ[0] = 1; }
  Status residual(double, In q, In, In a, Out r) noexcept override {
    r[0] = a[0] + (1 + s_) * q[0] + (q[0] > 5 ? s_ * s_ * (q[0] - 5) : 0);
    return Status::ok;
  }
  Status linearize(double, In, In, In, Weights) noexcept override { return Status::ok; }
  Status solve(In, Out) noexcept override { return Status::ok; }

 private:
  double s_;
};

// A run may visit states where a force turns, and no probe has to.
TEST(VariedSystem, BelievesNoProbeOfAParameterWhoseLawIsUnknown) {
  TurningSpring system(0);
  RunParameter parameter = [](double s) { return std::make_unique<TurningSpring>(s); };
  const auto systems = [&](ParameterLaw law) {
    parameter.law = law;
    const VariedSystem one = varied_system(system, parameter);
    EXPECT_EQ(one.simple.has_value(), law == ParameterLaw::smooth);
    return one.systems.size();
  };
  EXPECT_EQ(systems(ParameterLaw::unknown), central_stencil.at.size());
  EXPECT_EQ(systems(ParameterLaw::affine), 1u);
  EXPECT_EQ(systems(ParameterLaw::smooth), 1u);
}

}  // namespace tress::test_varied_system
