#include "experiments/validation/exact_rods.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "contract/input_error.h"
#include "experiments/validation/rods/numerics.h"

namespace tress::experiments::validation {
namespace {

struct Curl {
  double phi, poisson_ratio, gamma;

  /// theta and theta' over x = 1 - s, from the tip. Solutions that miss the clamp diverge
  /// like straight ones, to one side or the other, so that exactly one tip angle is
  /// right.
  void bend(double x, const double* y, double* dy) const {
    const bool missing = y[0] < 0 || y[1] > 0;
    dy[0] = y[1];
    dy[1] = gamma * x * (missing ? y[0] : std::sin(y[0]));
  }

  /// Two solutions (alpha, beta, X, Y) after theta and theta'.
  void turn(double x, const double* y, double* dy) const {
    bend(x, y, dy);
    const double k = -y[1], moment = k - phi;
    const double f_t = gamma * x * std::cos(y[0]), f_n = -gamma * x * std::sin(y[0]);
    for (int i = 2; i < 10; i += 4) {
      const double alpha = y[i], beta = y[i + 1], along = y[i + 2], across = y[i + 3];
      dy[i] = -(k * beta + (1 + poisson_ratio) * (along - moment * beta));
      dy[i + 1] = -(across + moment * alpha - k * alpha);
      dy[i + 2] = -(k * across - beta * f_n);
      dy[i + 3] = -(-k * along + beta * f_t);
    }
  }

  double tip_angle() const {
    const Slope slope = [this](double x, const double* y, double* dy) { bend(x, y, dy); };
    const auto at_clamp = [&](double tip) {
      return integrate_scaled(slope, 0, 1, {tip, -phi})[0];
    };
    return find_root(at_clamp, 0, std::numbers::pi);
  }

  /// Crosses 0 where the strand leaves the plane.
  double determinant() const {
    const Slope slope = [this](double x, const double* y, double* dy) { turn(x, y, dy); };
    const std::vector<double> y =
        integrate_scaled(slope, 0, 1, {tip_angle(), -phi, 1, 0, 0, 0, 0, 1, 0, 0});
    return y[2] * y[7] - y[3] * y[6];
  }
};

}  // namespace

double curl_threshold(double phi, double poisson_ratio) {
  constexpr double highest = 0.75, lowest = 0.35, step = 0.01;
  const auto determinant = [&](double ratio) {
    return Curl{phi, poisson_ratio, std::pow(ratio * phi, 3)}.determinant();
  };
  if (!(phi > 0 && phi <= 6 * std::numbers::pi && poisson_ratio >= 0.3)) {
    throw InputError(
        "no such curl", "phi",
        "give an angle above 0, at most 6 pi, and a Poisson ratio of 0.3 or more");
  }
  double above = highest, value = determinant(above);
  try {
    while (above > lowest) {
      const double below = above - step, next = determinant(below);
      if (value * next <= 0) return find_root(determinant, below, above, 1e-10);
      above = below;
      value = next;
    }
  } catch (const std::runtime_error&) {
    // The tip points up: such strands left their plane at a larger weight.
  }
  throw InputError("a strand of this phi stays in its plane at any weight", "phi",
                   "give an angle of 1.8 pi or more (nu = 0.5)");
}

PulledHelix pulled_helix(double natural_pitch_angle, double poisson_ratio, double force) {
  const double c0 = std::cos(natural_pitch_angle), s0 = std::sin(natural_pitch_angle);
  const double twisting = 1 / (1 + poisson_ratio);
  // No couple about the axis: linear in 1/r.
  const auto turns = [=](double a) {
    const double c = std::cos(a), s = std::sin(a);
    return (c0 * c0 * c + twisting * s0 * c0 * s) / (c * c * c + twisting * s * s * c);
  };
  const auto pull = [=](double a) {
    const double c = std::cos(a), s = std::sin(a), k = turns(a);
    const double bend = c * c * k - c0 * c0, twist = twisting * (s * c * k - s0 * c0);
    return (twist * c - bend * s) * k - force;
  };
  const double a = find_root(pull, natural_pitch_angle, std::numbers::pi / 2 - 1e-6);
  return {1 / turns(a), a};
}

PinnedElastica pinned_elastica(double eps) {
  struct End {
    double turn, along, across;  // u at the clamp; X, Y in the frame of the force
  };
  const auto shape = [](double tip, double size) {
    const auto y = integrate(
        [](double, const double* z, double* dz) {
          dz[0] = z[1];
          dz[1] = -std::sin(z[0]);
          dz[2] = std::cos(z[0]);
          dz[3] = std::sin(z[0]);
        },
        0, size, {-tip, 0, 0, 0});
    return End{y[0], y[2], y[3]};
  };
  const auto off_line = [&](double tip, double size) {
    const End s = shape(tip, size);
    return std::cos(s.turn) * s.across - std::sin(s.turn) * s.along;
  };
  const auto size_of = [&](double tip) {
    return find_root([&](double size) { return off_line(tip, size); }, 4.2, 6);
  };
  const auto shortening = [&](double tip) {
    const double size = size_of(tip);
    const End s = shape(tip, size);
    return 1 - (std::cos(s.turn) * s.along + std::sin(s.turn) * s.across) / size;
  };
  const double tip = find_root([&](double u) { return shortening(u) - eps; }, 1e-3, 2.2);
  const double size = size_of(tip);
  const double turn = shape(tip, size).turn;
  return {size * size * std::cos(turn), std::abs(size * size * std::sin(turn)),
          tip + turn};
}

}  // namespace tress::experiments::validation
