#include <gtest/gtest.h>

#include "contract/fill_in.h"
#include "models/catalogue.h"
#include "models/elements/element_rod.h"
#include "models/maximal/spring_strain.h"
#include "tests/support/catalogue_cases.h"
#include "tests/support/law_derivatives.h"

namespace tress::test_element_rod {

using namespace models;

using testing_support::law_derivative_error;
using testing_support::States;

/// The springs of mass_spring as laws.
template <class Strain, int n>
struct SpringLaw {
  static constexpr int nodes = n, strains = 1;

  template <class T>
  void strain(const Vec3<T>* x, T* s) const {
    Vec3<T> edges[n - 1];
    for (int k = 0; k + 1 < n; ++k) edges[k] = x[k + 1] - x[k];
    s[0] = Strain{}.value(edges);
  }
  void natural(double* s) const {
    if (n > 2) s[0] = std::sqrt(std::max(0.0, s[0] * s[0] - Hinge::delta * Hinge::delta));
  }
};
using Edge = SpringLaw<Chord<1>, 2>;
using Joint = SpringLaw<Hinge, 3>;

std::unique_ptr<System> of_laws(const Strand& strand, const Parameters&,
                                Effects effects) {
  ElementRod rod(strand, "of_laws");
  for (const auto& [first, segment] : rod.edges()) {
    const double area = segment.section.area();
    rod.add<Edge>(first, {},
                  {{strand.material.youngs_modulus * area / segment.length}, {0}});
  }
  for (const auto& [first, joint] : rod.joints()) {
    const double stiffness = (joint.stiffness.y + joint.stiffness.z) / 2;
    rod.add<Joint>(first, {}, {{stiffness}, {joint.friction.y}});
  }
  return std::move(rod).system(std::move(effects), LinearKind::automatic);
}

/// The clamp of mass_spring bends about two axes, whose strains have the same sum of
/// squares as the turning angle of a straight joint, but for Hinge::delta. At joints
/// turned by 0.05 or so that is (1e-6/0.05)^2 of the force, and friction at a rate is
/// regularised in the same way.
TEST(ElementRod, OfTheLawsOfMassSpringHasItsForcesEnergyAndPower) {
  constexpr double t = 0.3, rounding = 1e-8;
  for (const char* motion : {"rotate", "shake_rotate", "free"}) {
    const ModelEntry& entry = find_model("mass_spring");
    Parameters p(setup_parameters(entry), "model mass_spring");
    p.set("motion", motion);
    p.set("internal_friction_kg_m3_s", "0");
    const auto expected = entry.make(p);
    const auto system = of_laws(strand(p), p, strand_effects(p));
    States s(*expected);
    s.shake(0.3);
    std::vector<double> r(s.n), r0(s.n);
    ASSERT_EQ(expected->residual(t, s.q, s.v, s.a, r0), Status::ok);
    ASSERT_EQ(system->residual(t, s.q, s.v, s.a, r), Status::ok);
    double size = 0;
    for (const double x : r0) size = std::max(size, std::abs(x));
    for (std::size_t i = 0; i < s.n; ++i) EXPECT_NEAR(r[i], r0[i], rounding * size);
    const double energy = expected->energetics()->energy(t, s.q, s.v).total();
    EXPECT_NEAR(system->energetics()->energy(t, s.q, s.v).total(), energy,
                rounding * std::abs(energy));
    const double power = expected->energetics()->power(t, s.q, s.v);
    EXPECT_NEAR(system->energetics()->power(t, s.q, s.v), power,
                rounding * std::abs(power));
  }
}

/// Length of an edge, with derivatives by hand: t, and (I - t t^T)/length. `spoilt` is
/// added to one entry of each.
struct ByHand : Edge {
  double spoilt = 0;

  void gradient(const double* x, double (&g)[1][6]) const {
    const Vec e = load3(x + 3) - load3(x);
    for (int i = 0; i < 6; ++i) g[0][i] = (i < 3 ? -1 : 1) * part(e, i) / norm(e);
    g[0][2] += spoilt;
  }
  void add_second(const double* x, const double* stress, double (&h)[6][6]) const {
    const Vec e = load3(x + 3) - load3(x);
    const double l = norm(e);
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 6; ++j) {
        const double one = i % 3 == j % 3 ? 1 : 0, sign = i / 3 == j / 3 ? 1 : -1;
        h[i][j] += stress[0] * sign * (one - part(e, i) * part(e, j) / (l * l)) / l;
      }
    }
    h[4][1] += spoilt;
  }
  static double part(const Vec& e, int i) {
    return i % 3 == 0 ? e.x : i % 3 == 1 ? e.y : e.z;
  }
};

TEST(RodLaw, DerivativesByHandAreThoseOfDualNumbers) {
  const double x[] = {0.1, -0.2, 0.3, 0.8, 0.5, -0.4};
  constexpr double rounding = 100 * std::numeric_limits<double>::epsilon();
  for (const double error : law_derivative_error(ByHand{}, x)) EXPECT_LE(error, rounding);
  // A millionth too much is seen.
  for (const double error : law_derivative_error(ByHand{{}, 1e-6}, x)) {
    EXPECT_GT(error, 1e-7);
  }
}

TEST(FillIn, NamesFileLineAndWhatIsToBeWritten) {
  const int line = __LINE__ + 2;
  try {
    fill_in("the strains");
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("still to be written: the strains"), std::string::npos);
    EXPECT_NE(text.find("test_element_rod.cpp:" + std::to_string(line) + ":"),
              std::string::npos)
        << text;
  }
}

}  // namespace tress::test_element_rod
