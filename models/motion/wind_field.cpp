#include "models/motion/wind_field.h"

#include <random>

namespace tress::models {
namespace {

using std::numbers::pi;

/// Uniform numbers independent of the standard library's implementation.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : bits_(seed) {}
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(bits_() >> 11) * 0x1p-53;
  }
  /// Of length 1, uniform over the sphere [Archimedes: z is uniform].
  Vec direction() {
    const double z = between(-1, 1), angle = between(0, 2 * pi);
    const double r = std::sqrt(1 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
  }

 private:
  std::mt19937_64 bits_;
};

Vec unit(const Vec& a) { return (1 / norm(a)) * a; }

/// A uniformly distributed direction orthogonal to k.
Vec across(Dice& dice, const Vec& k) {
  for (;;) {
    const Vec e = cross(k, dice.direction());
    if (dot(e, e) > 1e-6) return unit(e);
  }
}

}  // namespace

Gusts::Gusts(Vec mean, double rms, double length, double time, std::uint64_t seed)
    : mean_(mean) {
  Dice dice(seed);
  double square = 0;
  for (int m = 0; m < waves; ++m) {
    const double scale = std::pow(4.0, (m + 0.5) / waves - 0.5);  // of |k|, 1/2 to 2
    const Vec direction = dice.direction();
    const Vec k = (2 * pi / length * scale) * direction;
    const double speed = std::pow(scale, -1.0 / 3);
    const double turn = 2 * pi / time * std::pow(scale, 2.0 / 3);
    const double omega = dice.between(-1, 1) < 0 ? -turn : turn;
    waves_.push_back({speed * across(dice, direction), k, omega - dot(k, mean),
                      dice.between(0, 2 * pi)});
    square += speed * speed / 2;  // the mean of cos^2; waves of two lengths do not mix
  }
  for (Wave& wave : waves_) wave.e = (rms / std::sqrt(square)) * wave.e;
}

Vec Gusts::velocity(double t, const Vec& x) const {
  Vec w = mean_;
  for (const Wave& wave : waves_) w = w + std::cos(wave.angle(t, x)) * wave.e;
  return w;
}

Mat3 Gusts::gradient(double t, const Vec& x) const {
  Mat3 sum{};
  for (const Wave& wave : waves_) {
    sum = sum - std::sin(wave.angle(t, x)) * outer(wave.e, wave.k);
  }
  return sum;
}

}  // namespace tress::models
