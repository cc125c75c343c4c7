#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "contract/input_error.h"
#include "models/contact/contact_law.h"
#include "tests/support/catalogue_cases.h"

namespace tress::test_contact_law {

using namespace models;

using namespace testing_support;

constexpr ContactLaw::Values values{
    .stiffness = 2e-4, .viscosity = 2e-3, .inner = 3e-3, .outer = 6e-3};
const ContactLaw law(values, "test");

TEST(ContactLaw, IsTheSeedsBetweenStrandsAtRest) {
  // P d/rho in place of P: (1e-3 P/d)^2/2 = 2e-6 less at d = P/2.
  const double d = values.inner / 2;
  const Vec f = law.force({0, d, 0}, {});
  EXPECT_NEAR(f.y, values.stiffness * (values.inner - d),
              2e-6 * values.stiffness * values.inner);
  EXPECT_EQ(f.x, 0);
  EXPECT_EQ(law.force({0, 1.001 * values.inner, 0}, {}).y, 0);
}

TEST(ContactLaw, ViscousForceFadesWithoutKinks) {
  const auto drag = [](double d) { return -law.force({0, d, 0}, {1, 0, 0}).x; };
  EXPECT_DOUBLE_EQ(drag(0.9 * values.inner), values.viscosity);
  // The middle of w, its slope 1.5/P times rho - d = (1e-3 P)^2/(2 d).
  EXPECT_NEAR(drag(1.5 * values.inner), values.viscosity / 2, 5e-7 * values.viscosity);
  EXPECT_EQ(drag(1.001 * values.outer), 0);
  EXPECT_EQ(law.reach(), values.outer);
  // w' is continuous: at most 6 s (1 - s) = 6e-3 of D over the width beside the ends.
  for (const double end : {values.inner, values.outer}) {
    const double width = values.outer - values.inner, e = 1e-3 * width;
    const double before = (drag(end) - drag(end - e)) / e;
    const double after = (drag(end + e) - drag(end)) / e;
    EXPECT_LE(std::abs(after - before), 6.1e-3 * values.viscosity / width);
  }
}

TEST(ContactLaw, WithoutViscosityNothingReachesBeyondTheInnerRadius) {
  ContactLaw::Values dry = values;
  dry.viscosity = 0;
  EXPECT_EQ(ContactLaw(dry, "test").reach(), values.inner);
}

TEST(ContactLaw, StaysFiniteWhereStrandsCoincide) {
  const Vec f = law.force({}, {});
  EXPECT_EQ(dot(f, f), 0);
  const ContactLaw::Slopes slopes = law.slopes({}, {1, 2, 3});
  for (const double entry : slopes.by_gap) EXPECT_TRUE(std::isfinite(entry));
  // K (P - d) at most, whatever the direction.
  for (double d = 1e-12; d < values.inner; d *= 3) {
    const Vec push = law.force({d, 0, 0}, {});
    EXPECT_LE(push.x, values.stiffness * values.inner);
    EXPECT_GE(push.x, 0);
  }
}

TEST(ContactLaw, RepulsionIsTheDescentOfItsPotential) {
  const Vec d{1e-3, -1.2e-3, 0.7e-3}, e{0.3, -0.2, 0.5};
  const std::vector<double> slope = central_difference(
      difference_step * 1e-3,
      [&](double step) { return std::vector<double>{law.potential(d + step * e)}; });
  // The stencil leaves 1e-12 or so of K P d, which dot(f, e) is about.
  EXPECT_NEAR(slope[0], -dot(law.force(d, {}), e),
              1e-10 * values.stiffness * values.inner);
}

TEST(ContactLaw, SlopesAreDifferencesOfTheForce) {
  const Vec u{0.4, 0.1, -0.3};
  for (const Vec d : {Vec{1e-3, -1.2e-3, 0.7e-3}, Vec{3e-3, 2e-3, 1e-3},
                      Vec{1e-6, 2e-6, -1e-6}, Vec{5e-3, 5e-3, 5e-3}}) {
    const ContactLaw::Slopes slopes = law.slopes(d, u);
    // The law changes over |d|, and over its own rounding off near 0.
    const double size = std::max(1e-3 * values.inner, norm(d));
    const Vec axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (std::size_t j = 0; j < 3; ++j) {
      const auto by_gap = central_difference(difference_step * size, [&](double step) {
        std::vector<double> f(3);
        store3(law.force(d + step * axes[j], u), f.data());
        return f;
      });
      const auto by_velocity = central_difference(difference_step, [&](double step) {
        std::vector<double> f(3);
        store3(law.force(d, u + step * axes[j]), f.data());
        return f;
      });
      // Truncation (e/size)^4 = 3e-13 times ratios of derivatives, and as much rounding,
      // of forces D u and K P over `size`.
      const double bound =
          1e-9 * (values.stiffness * values.inner + values.viscosity) / size;
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(slopes.by_gap[3 * i + j], by_gap[i], bound);
        EXPECT_NEAR(i == j ? slopes.by_velocity : 0, by_velocity[i],
                    1e-9 * values.viscosity);
      }
    }
  }
}

TEST(ContactLaw, RefusesRadiiThatLeaveNoRoom) {
  ContactLaw::Values bad = values;
  bad.outer = bad.inner;
  EXPECT_THROW(ContactLaw(bad, "test"), InputError);
  bad = values;
  bad.stiffness = std::nan("");
  EXPECT_THROW(ContactLaw(bad, "test"), InputError);
  bad = values;
  bad.outer = std::numeric_limits<double>::infinity();
  EXPECT_THROW(ContactLaw(bad, "test"), InputError);
}

}  // namespace tress::test_contact_law
