#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>

#include "experiments/validation/rods/signals.h"

namespace tress::test_signals {

using namespace experiments;
using namespace experiments::validation;

constexpr double rate = 7, step = 0.005;  // rad/s, s
constexpr double coarse = rate * step;    // omega h = 0.035
constexpr double duration = 1000 * step + 1e-9;

Track seen(const std::function<double(double)>& f) {
  Track track;
  for (double t = 0; t < duration; t += step) {
    track.t.push_back(t);
    track.value.push_back(f(t));
  }
  return track;
}

// The chord through a zero of a sine is off by h (omega h)^2/24 at most, at its third
// derivative's (x s (1 - s) (1 - 2 s)/6, largest 0.016): twice that between two.
TEST(Signals, PeriodIsThatOfASine) {
  const Track sine = seen([](double t) { return std::sin(rate * t + 0.3); });
  const double exact = 2 * std::numbers::pi / rate;
  EXPECT_NEAR(period(sine), exact, 2 * step * coarse * coarse / 24);
  EXPECT_THROW((void)period(seen([](double) { return 1.0; })), std::runtime_error);
}

// A parabola's vertex is found exactly; the fourth derivative of a Gaussian of width w,
// 3 (h/w)^2/w^2 of its second, moves it by (h/w)^2 h/2 at most.
TEST(Signals, PeakIsThatOfABump) {
  constexpr double at = 1.2347, width = 0.1;
  const Track bump =
      seen([](double t) { return std::exp(-(t - at) * (t - at) / (2 * width * width)); });
  EXPECT_NEAR(time_of_peak(bump), at, step * std::pow(step / width, 2) / 2);
}

// The transform of a Hann window of duration T falls to 8 pi^2/(d T)^3 and less at a rate
// d away, and is steep there by T/2 times that; at the peak its bend is T^2 (1/12 - 1/(2
// pi^2)). Others here: 2 rates away the sine's own mirror and half of it, 4 away half.
TEST(Signals, StrongestRateOfTwo) {
  const Track both = seen(
      [](double t) { return 5 + std::sin(rate * t) + 0.5 * std::sin(3 * rate * t + 1); });
  const double pi = std::numbers::pi, apart = 2 * rate * duration;
  const double others = (1 + 0.5 + 0.5 / 8) * 8 * pi * pi / std::pow(apart, 3);
  const double bend = 1.0 / 12 - 1 / (2 * pi * pi);
  EXPECT_NEAR(strongest_rate(both, 0.6 * rate, 1.5 * rate), rate,
              others / 2 / bend / duration);
}

// Turning points are found to (omega h)^4 of the swing, which the logarithm over n swings
// sees as that over the duration.
TEST(Signals, DecayIsThatOfAnExponential) {
  constexpr double decay = 0.4;
  const Track dying =
      seen([](double t) { return std::exp(-decay * t) * std::cos(rate * t); });
  EXPECT_NEAR(decay_rate(dying), decay, 12 * std::pow(coarse, 4) / duration);
}

}  // namespace tress::test_signals
