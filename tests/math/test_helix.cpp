#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "math/dual.h"
#include "math/helix.h"

namespace tress::test_helix {

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr int count = 9;
using Nine = std::array<long double, count>;

template <class T>
std::array<T, count> listed(const HelixFunctions<T>& f) {
  return {f.S, f.A, f.B, f.A1, f.B1, f.A2, f.B2, f.A3, f.B3};
}
const char* const name[count] = {"S", "A", "B", "A1", "B1", "A2", "B2", "A3", "B3"};

// F = s^power times a function of ws that starts at `start` and oscillates like
// (ws)^-decay.
constexpr int power[count] = {1, 2, 3, 4, 5, 6, 7, 8, 9};
constexpr int decay[count] = {1, 2, 2, 3, 4, 4, 5, 5, 6};
constexpr long double start[count] = {1,          1 / 2.0L,    1 / 6.0L,
                                      -1 / 12.0L, -1 / 60.0L,  1 / 90.0L,
                                      1 / 630.0L, -1 / 840.0L, -1 / 7560.0L};

long double size(int i, long double ws) {
  const long double oscillation = std::pow(ws, static_cast<long double>(-decay[i]));
  return std::min(std::abs(start[i]), oscillation);
}

// The reference: S, A and B for s = 1 as functions of X = w^2 in extended precision, and
// F'(w)/w = 2 dF/dX taken by derivative numbers.
using One = Dual<1, long double>;
using Two = Dual<1, One>;
using Three = Dual<1, Two>;
using Base = std::array<Three, 3>;

Three unknown(long double x) {
  One first(x);
  first.part[0] = 1;
  Two second(first);
  second.part[0] = 1;
  Three third(second);
  third.part[0] = 1;
  return third;
}

Base by_power_series(const Three& x) {
  Base f;
  for (int p = 1; p <= 3; ++p) {
    Three term(1 / std::tgamma(1.0L + static_cast<long double>(p)));
    for (int k = 1; k < 60; ++k) {
      f[static_cast<std::size_t>(p - 1)] += term;
      term = (-1.0L / ((2 * k + p - 1) * (2 * k + p))) * (term * x);
    }
  }
  return f;
}

Base by_closed_forms(const Three& x) {
  const Three w = sqrt(x);
  return {sin(w) / w, (Three(1) - cos(w)) / x, (w - sin(w)) / (w * x)};
}

Nine derivatives(const Base& f) {
  const auto& [s, a, b] = f;
  const auto first = [](const Three& y) { return 2 * y.part[0].value.value; };
  const auto second = [](const Three& y) { return 4 * y.part[0].part[0].value; };
  const auto third = [](const Three& y) { return 8 * y.part[0].part[0].part[0]; };
  return {s.value.value.value,
          a.value.value.value,
          b.value.value.value,
          first(a),
          first(b),
          second(a),
          second(b),
          third(a),
          third(b)};
}

// At ws = 6 the terms of the series are up to e^6 / 6^3 = 2 in size and those of the
// closed forms cancel from 100 times the result: with 2^-64, 1e-17 of the result on
// either side.
Nine reference(long double ws) {
  const Three x = unknown(ws * ws);
  return derivatives(ws < 6 ? by_power_series(x) : by_closed_forms(x));
}

/// What the header promises. 8 eps: the power s^9 takes 8 roundings, the sum and X two
/// more each, half an eps apiece. Up to ws = 4.5 the terms of w^2 B add up to
/// sinh(4.5)/4.5 = 10 where S has the size 2/9. Beyond, closed forms: dB3 = 105/(ws)^6
/// dB, where dB is half an eps of 1/(ws)^2, makes 5 eps of B3 at 4.5, and A to B2 add
/// theirs; at 50 the root w is rounded by half an eps, ws by 2^-48: 9.1e-15 together.
long double tolerance(int i, double ws, long double value) {
  if (ws <= 2) return 8 * eps * std::abs(value);
  if (ws <= 4.5) return 15 * eps * size(i, ws);
  return std::min(std::max(20.0, ws) * eps, 1e-14) * size(i, ws);
}

std::vector<double> angles() {
  std::vector<double> all;
  for (int k = 1; k <= 2500; ++k) all.push_back(0.02 * k - 0.003);
  for (int k = 0; k <= 200; ++k) all.push_back(std::pow(10, -0.06 * k));
  for (const double end : {1.5, 4.5}) {
    for (int k = -20; k <= 20; ++k) all.push_back(end * (1 + 1e-12 * k * k * k));
  }
  return all;
}

TEST(HelixReference, PowerSeriesAndClosedFormsAgreeWhereBothAreGood) {
  for (const long double ws : {5.5L, 6.0L, 6.5L}) {
    const Nine a = derivatives(by_power_series(unknown(ws * ws)));
    const Nine b = derivatives(by_closed_forms(unknown(ws * ws)));
    for (int i = 0; i < count; ++i) {
      const auto k = static_cast<std::size_t>(i);
      EXPECT_LE(std::abs(a[k] - b[k]), 0.2L * eps * size(i, ws)) << name[i];
    }
  }
}

/// The error of all nine at arc length s of an element that is `longest` long.
void expect_accurate(double s, double x2, double longest) {
  const long double ws = std::sqrt(static_cast<long double>(x2)) * s;
  const Nine exact = reference(ws);
  const auto got = listed(helix_functions(s, x2, longest));
  for (int i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const long double scaled = got[k] / std::pow(static_cast<long double>(s), power[i]);
    EXPECT_LE(std::abs(scaled - exact[k]),
              tolerance(i, static_cast<double>(ws), exact[k]))
        << name[i] << " at ws = " << static_cast<double>(ws) << " of "
        << std::sqrt(x2) * longest << ", error in eps of size "
        << static_cast<double>((scaled - exact[k]) / (eps * size(i, ws)));
  }
}

TEST(HelixFunctions, AreAccurateFromStraightToEightTurns) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> decade(-1, 4);
  for (const double ws : angles()) {
    const double w = std::pow(10, decade(random));  // 1/m
    expect_accurate(ws / w, w * w, ws / w);
  }
}

TEST(HelixFunctions, AreAccurateAtTheStartOfALongElement) {
  for (const double ws : angles()) {
    const double w = 300;
    for (const double longest : {3.0, 50.0}) {  // long series, lane by lane
      if (ws < longest) expect_accurate(ws / w, w * w, longest / w);
    }
  }
}

void expect_same(const HelixFunctions<double>& one, const HelixFunctions<double>& other,
                 double x, double tolerance) {
  for (int i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    EXPECT_LE(std::abs(listed(one)[k] - listed(other)[k]),
              tolerance * size(i, std::sqrt(x)))
        << name[i] << " at X = " << x;
  }
}

// Both ways keep to their tolerance: 8 eps twice at 1.5; 15 and 20 eps at 4.5.
TEST(HelixFunctions, DoNotJumpWhereTheWayChanges) {
  const double x = helix::short_end, y = helix::long_end;
  expect_same(helix::series<9>(1.0, x), helix::series<16>(1.0, x), x, 16 * eps);
  expect_same(helix::series<16>(1.0, y), helix::closed_forms(1.0, y), y, 35 * eps);
}

TEST(HelixFunctions, GoSmoothlyThroughTheStraightElement) {
  const double s = 0.013;
  for (const double w : {0.0, 1e-300, 1e-160, 1e-12}) {
    const auto got = listed(helix_functions(s, w * w, s));
    for (int i = 0; i < count; ++i) {
      const long double exact =
          start[i] * std::pow(static_cast<long double>(s), power[i]);
      EXPECT_NEAR(static_cast<double>(got[static_cast<std::size_t>(i)] / exact), 1,
                  8 * eps)
          << name[i] << " at w = " << w;
    }
  }
}

TEST(HelixFunctions, VanishAtTheRootOfAnyElement) {
  for (const double w : {0.0, 1.0, 3.0, 1e4}) {
    for (const double f : listed(helix_functions(0.0, w * w, 1.0))) EXPECT_EQ(f, 0);
  }
}

TEST(HelixFunctions, AreOddAndEvenInArcLength) {
  for (const double s : {0.7, 3.0, 20.0}) {
    const auto ahead = listed(helix_functions(s, 1.0, s));
    const auto back = listed(helix_functions(-s, 1.0, s));
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(back[i], power[i] % 2 == 0 ? ahead[i] : -ahead[i]) << name[i];
    }
  }
}

// Lanes and scalars may fuse different products of a sum a b + c d: each has rounded one
// product and the sum.
TEST(HelixFunctions, LanesEqualScalars) {
  const std::array<double, 4> points{0.07, 0.33, 0.67, 0.93};
  for (const double w : {0.0, 0.3, 1.4, 3.0, 6.0, 30.0}) {
    const auto packs = listed(helix_functions(Pack::load(points.data()), w * w, 1.0));
    for (int lane = 0; lane < Pack::lanes; ++lane) {
      const double s = points[static_cast<std::size_t>(lane)];
      const auto one = listed(helix_functions(s, w * w, 1.0));
      for (int i = 0; i < count; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const double unit =
            eps * static_cast<double>(size(i, w * s)) * std::pow(s, power[i]);
        EXPECT_NEAR(packs[k][lane], one[k], 2 * unit) << name[i] << " w = " << w;
      }
    }
  }
}

}  // namespace tress::test_helix
