#pragma once

#include <random>
#include <vector>

#include "math/vec3.h"

/// Strands as wandering polylines that drift along, for tests of what they do to each
/// other.
namespace tress::testing_support {

struct Polylines {
  std::vector<int> points;
  std::vector<double> x, v;

  /// Roots anywhere in a cube of side `box` (m), segments of `edge` (m), their directions
  /// wandering, velocities up to `speed` (m/s).
  Polylines(int strands, int segments, double box, double edge, double speed,
            unsigned seed)
      : points(static_cast<std::size_t>(strands), segments + 1), random_(seed) {
    for (int k = 0; k < strands; ++k) {
      Vec at = box * random_vec(), along = random_vec();
      const Vec drift = speed * random_vec();
      for (int i = 0; i <= segments; ++i) {
        append(at, x);
        append(drift + 0.3 * speed * random_vec(), v);
        along = along + 0.5 * random_vec();
        at = at + (edge / norm(along)) * along;
      }
    }
  }

  void move(double h) {
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += h * v[i];
  }

  Vec random_vec() { return {uniform(), uniform(), uniform()}; }
  double uniform() { return std::uniform_real_distribution<double>(-0.5, 0.5)(random_); }

 private:
  static void append(const Vec& a, std::vector<double>& to) {
    to.insert(to.end(), {a.x, a.y, a.z});
  }
  std::mt19937 random_;
};

}  // namespace tress::testing_support
