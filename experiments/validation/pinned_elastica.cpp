#include "experiments/validation/pinned_elastica.h"

#include <cmath>

#include "experiments/validation/rods/numerics.h"

namespace tress::experiments::validation {

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
