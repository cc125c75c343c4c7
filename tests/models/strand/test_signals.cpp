#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "contract/input_error.h"
#include "models/motion/signals.h"
#include "models/motion/teleport.h"

namespace tress::test_signals {

using namespace models;

using std::numbers::pi;

/// f'(t) by five points; error h^4/30 |f'''''| + 1.5 eps |f|/h.
template <class F>
double slope(const F& f, double t) {
  const double h = 1e-4;
  return (8 * (f(t + h) - f(t - h)) - (f(t + 2 * h) - f(t - 2 * h))) / (12 * h);
}

void expect_derivatives(const Signal& signal, double t, double tolerance) {
  const SignalValue at = signal(t);
  EXPECT_NEAR(slope([&](double s) { return signal(s).value; }, t), at.rate, tolerance);
  EXPECT_NEAR(slope([&](double s) { return signal(s).rate; }, t), at.acceleration,
              tolerance);
}

struct Case {
  std::string name;
  Oscillator body;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class OscillatorTest : public testing::TestWithParam<Case> {};

/// The acceleration is that of the equation of motion; that value and rate belong to it
/// shows that they solve it. Rates of change are at most 48 1/s (the fast root of the
/// overdamped one) and |x| < 1, so a sixth derivative is below 48^6 = 1.2e10: tolerance
/// h^4/30 times that, 4.1e-8, and rounding below 1e-9.
TEST_P(OscillatorTest, SolvesItsEquationFromRest) {
  const Oscillator& body = GetParam().body;
  const double t0 = 0.3;
  const Signal x = driven_oscillator(body, t0);
  for (const double t : {0.31, 0.4, 0.77, 1.3, 2.0}) {
    expect_derivatives(x, t, 4.3e-8);
    const SignalValue at = x(t);
    const double torque = body.force * std::sin(2 * pi * body.frequency * (t - t0));
    EXPECT_NEAR(body.inertia * at.acceleration + body.damping * at.rate +
                    body.stiffness * at.value,
                torque, 1e-13);
  }
  EXPECT_EQ(x(0.1).value, 0);
  // Just after t0 the acceleration is f W (t - t0), 280/s^3 times 1 ns.
  EXPECT_NEAR(x(t0 + 1e-9).acceleration, 0, 3e-7);
  EXPECT_NEAR(x(t0 + 1e-9).rate, 0, 1e-12);
  EXPECT_NEAR(x(t0 + 1e-9).value, 0, 1e-12);
}

Oscillator head(double damping, double stiffness) {
  return {.inertia = 0.02,
          .damping = damping,
          .stiffness = stiffness,
          .force = 0.6,
          .frequency = 1.5};
}
INSTANTIATE_TEST_SUITE_P(
    Signals, OscillatorTest,
    testing::Values(Case{"Underdamped", head(0.1, 2)}, Case{"Overdamped", head(1, 2)},
                    Case{"Critical", head(0.4, 2)}, Case{"Undamped", head(0, 2)},
                    Case{"NoStiffness", head(0.1, 0)}, Case{"Free", head(0, 0)}),
    [](const auto& tested) { return tested.param.name; });

TEST(Oscillator, RefusesTheUndampedResonanceAndNumbersOutOfRange) {
  Oscillator body{.stiffness = 4 * pi * pi, .force = 1};
  EXPECT_THROW(driven_oscillator(body, 0), InputError);
  body.damping = 0.1;
  EXPECT_NO_THROW(driven_oscillator(body, 0));
  body.inertia = 0;
  EXPECT_THROW(driven_oscillator(body, 0), InputError);
}

const std::vector<double> times{0.2, 0.7, 1.4, 2.2}, values{0.3, 0.1, -0.2, 0.4};

TEST(Keyframes, GoThroughTheirValuesAndRestOutside) {
  const Signal x = keyframes(times, values);
  for (std::size_t i = 0; i < times.size(); ++i) {
    EXPECT_NEAR(x(times[i]).value, values[i], 1e-15);
  }
  for (const double t : {-1.0, 5.0}) {
    EXPECT_EQ(x(t).value, t < 0 ? values.front() : values.back());
    EXPECT_EQ(x(t).rate, 0);
    EXPECT_EQ(x(t).acceleration, 0);
  }
}

/// Cubics between the knots, for which differences are exact: rounding of accelerations
/// below 20 m/s^2 is 1.5 eps 20/h = 7e-11.
TEST(Keyframes, HaveTheirDerivatives) {
  const Signal x = keyframes(times, values);
  for (const double t : {0.3, 0.52, 1.0, 1.7, 2.1}) expect_derivatives(x, t, 7e-11);
}

/// Over 2 ns an acceleration changes by 2e-9 s of its slope, which stays below 500 m/s^3.
TEST(Keyframes, AreSmoothAtEveryKnotAndAtBothEnds) {
  const Signal x = keyframes(times, values);
  for (const double t : {0.2, 0.45, 0.7, 1.4, 1.8, 2.2}) {
    const SignalValue before = x(t - 1e-9), after = x(t + 1e-9);
    EXPECT_NEAR(before.value, after.value, 1e-8);
    EXPECT_NEAR(before.rate, after.rate, 1e-7);
    EXPECT_NEAR(before.acceleration, after.acceleration, 1e-6);
  }
}

TEST(Keyframes, OfOneIntervalAreSymmetric) {
  const Signal x = keyframes({1, 3}, {-1, 1});
  EXPECT_NEAR(x(2).value, 0, 1e-15);
  EXPECT_NEAR(x(1.4).value, -x(2.6).value, 1e-15);
  expect_derivatives(x, 1.3, 7e-11);
}

/// Before and after a jump the signal is a spline of its own, which goes on at its speed:
/// one without bending through two rows.
TEST(Keyframes, JumpBetweenRowsWithTheSameTime) {
  const Signal x = keyframes({0, 1, 2, 2, 3, 3, 4}, {0, 1, 3, -1, 1, 5, 5});
  const double before = std::nextafter(teleport_time(2), 0.0);
  EXPECT_NEAR(x(before).value, 3, 1e-14);
  EXPECT_EQ(x(before).acceleration, 0);
  EXPECT_GT(x(before).rate, 1);
  EXPECT_NEAR(x(2).value, -1, 1e-14);
  EXPECT_NEAR(x(2.5).value, 0, 1e-14);
  EXPECT_NEAR(x(2.5).rate, 2, 1e-14);
  EXPECT_EQ(x(3).value, 5);
  EXPECT_EQ(x(5).value, 5);
  for (const double t : {0.3, 0.7, 1.5, 2.2}) expect_derivatives(x, t, 7e-11);
}

TEST(Keyframes, MustBeInOrder) {
  EXPECT_THROW(keyframes({0, 0, 0}, {0, 1, 2}), InputError);
  EXPECT_THROW(keyframes({0, 1, 0.5}, {0, 1, 2}), InputError);
  EXPECT_THROW(keyframes({0}, {0}), InputError);
  EXPECT_THROW(keyframes({0, 1, NAN}, {0, 1, 2}), InputError);
  EXPECT_THROW(keyframes({0, 1e-300}, {0, 1}), InputError);
}

TEST(ThereAndBack, ReturnsToRest) {
  const Signal x = there_and_back(0.1, 0.5);
  EXPECT_EQ(x(0.5).value, 0.1);
  EXPECT_EQ(x(1).value, 0);
  EXPECT_EQ(x(1).rate, 0);
}

}  // namespace tress::test_signals
