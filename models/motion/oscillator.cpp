#include <cmath>
#include <numbers>

#include "contract/input_error.h"
#include "models/motion/signals.h"

namespace tress::models {
namespace {

/// The two solutions of y'' + d2 y = 0 with (y, y') = (1, 0) and (0, 1) at t = 0; their
/// derivatives are -d2 sine and cosine.
struct Pair {
  double cosine, sine;
};

/// sin(x)/x or sinh(x)/x for the x^2 that may be negative.
double slope(double x2) {
  // Left out below 1e-4: x^6/5040 = 2e-16 of the value.
  if (std::abs(x2) < 1e-4) return 1 - x2 / 6 * (1 - x2 / 20);
  const double x = std::sqrt(std::abs(x2));
  return x2 > 0 ? std::sin(x) / x : std::sinh(x) / x;
}

Pair pair(double d2, double t) {
  const double x2 = d2 * t * t;
  const double x = std::sqrt(std::abs(x2));
  return {x2 > 0 ? std::cos(x) : std::cosh(x), t * slope(x2)};
}

void check(const Oscillator& body, double t0) {
  const double all =
      body.inertia + body.damping + body.stiffness + body.force + body.frequency + t0;
  if (std::isfinite(all) && body.inertia > 0 && body.damping >= 0 &&
      body.stiffness >= 0 && body.frequency > 0) {
    return;
  }
  throw InputError("an oscillator's number is out of range", "signal of a root motion",
                   "give inertia and frequency > 0, damping and stiffness >= 0");
}

}  // namespace

Signal driven_oscillator(const Oscillator& body, double t0) {
  check(body, t0);
  const double drive = 2 * std::numbers::pi * body.frequency;
  const double d = body.damping / (2 * body.inertia);
  const double w2 = body.stiffness / body.inertia;
  const double f = body.force / body.inertia;
  const double away = w2 - drive * drive, friction = 2 * d * drive;
  const double norm = away * away + friction * friction;
  const double rounding = 1e-14 * (w2 + drive * drive);
  if (!(norm > rounding * rounding)) {
    throw InputError("an undamped oscillator is driven at its own frequency",
                     "signal of a root motion", "give damping > 0 or another frequency");
  }
  const double p = f * away / norm, q = -f * friction / norm;
  const double d2 = w2 - d * d;  // squared rate of the free oscillation
  const double start = p * drive + d * q;
  const auto value = [=](double time) -> SignalValue {
    const double t = time - t0;
    if (t <= 0) return {};
    const double c = std::cos(drive * t), s = std::sin(drive * t);
    const auto [cosine, sine] = pair(d2, t);
    const double decay = std::exp(-d * t);
    // y = q cosine + start sine and its derivative; the free part is -exp(-d t) y.
    const double y = q * cosine + start * sine;
    const double y_rate = start * cosine - d2 * q * sine;
    const double x = p * s + q * c - decay * y;
    const double rate = drive * (p * c - q * s) + decay * (d * y - y_rate);
    return {x, rate, f * s - 2 * d * rate - w2 * x};
  };
  return {value, {t0}};
}

}  // namespace tress::models
