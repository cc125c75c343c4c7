#pragma once

#include <limits>
#include <random>
#include <vector>

#include "math/mat3.h"
#include "models/effects/effect.h"

namespace tress::testing_support {

using namespace models;

/// Points for effects to act on, filled at random: places in [-1, 1]^3 m, velocities up
/// to 3 m/s of which some are small and some 0, tangents of length 1. Reproducible: equal
/// seeds, equal points.
struct Cloud {
  std::vector<double> x, v, tangent, mass, length, arc;

  explicit Cloud(std::size_t count, unsigned seed = 7) {
    std::mt19937 random(seed);
    const auto draw = [&random] {  // in (-1, 1)
      return (static_cast<double>(random()) - 0x7fffffffp0) * 0x1p-31;
    };
    for (std::size_t i = 0; i < count; ++i) {
      const double speed = i % 4 == 0 ? 0.1 : 3;
      const Vec t{draw(), draw(), draw()};
      const Vec unit = (1 / norm(t)) * t;
      for (int k = 0; k < 3; ++k) {
        x.push_back(draw());
        v.push_back(i % 8 == 1 ? 0 : speed * draw());
      }
      for (const double e : {unit.x, unit.y, unit.z}) tangent.push_back(e);
      mass.push_back(0.2 + 0.1 * draw());
      length.push_back(0.3 + 0.2 * draw());
      arc.push_back((arc.empty() ? 0 : arc.back()) + length.back());
    }
  }

  std::size_t count() const { return mass.size(); }
  Points points() const {
    Points p{static_cast<int>(count()), x, v, tangent, mass, length};
    p.arc = arc;
    p.longest = arc.back();
    return p;
  }
  /// The same, NaN where an effect says it does not look.
  Points only(const Needs& needs) {
    blank.assign(x.size(), std::numeric_limits<double>::quiet_NaN());
    Points p = points();
    if (!needs.position) p.x = blank;
    if (!needs.velocity) p.v = blank;
    if (!needs.tangent) p.tangent = blank;
    return p;
  }

  std::vector<double> blank;
};

inline std::vector<double> load(const Effect& effect, double t, const Points& p) {
  std::vector<double> f(3 * p.mass.size(), 0.0);
  effect.add_load(t, p, f);
  return f;
}

inline std::vector<double> derivatives(const Effect& effect, double t, const Points& p,
                                       double pos, double vel) {
  std::vector<double> blocks(9 * p.mass.size(), 0.0);
  effect.add_derivatives(t, p, pos, vel, blocks);
  return blocks;
}

}  // namespace tress::testing_support
