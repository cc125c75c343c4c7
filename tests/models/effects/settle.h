#pragma once

#include <initializer_list>
#include <vector>

#include "tests/models/effects/cloud.h"

namespace tress::testing_support {

using namespace models;

/// Moves free points under effects by the classical Runge-Kutta method of order 4, whose
/// fixed points are those of the equations. Tangents stay as they are.
class FreePoints {
 public:
  FreePoints(Cloud start, std::vector<const Effect*> effects)
      : points(std::move(start)), effects_(std::move(effects)) {}

  void run(double duration, int steps) {
    const double h = duration / steps;
    for (int i = 0; i < steps; ++i, time += h) step(h);
  }

  Vec place(std::size_t i) const { return load3(&points.x[3 * i]); }
  Vec velocity(std::size_t i) const { return load3(&points.v[3 * i]); }

  Cloud points;
  double time = 0;

 private:
  using Numbers = std::vector<double>;

  Numbers acceleration(double t, const Numbers& x, const Numbers& v) const {
    Points p = points.points();
    p.x = x;
    p.v = v;
    Numbers a(x.size(), 0.0);
    for (const Effect* effect : effects_) effect->add_load(t, p, a);
    for (std::size_t i = 0; i < a.size(); ++i) a[i] /= points.mass[i / 3];
    return a;
  }
  static Numbers ahead(const Numbers& y, double h, const Numbers& rate) {
    Numbers sum = y;
    for (std::size_t i = 0; i < y.size(); ++i) sum[i] += h * rate[i];
    return sum;
  }
  void step(double h) {
    auto& [x, v, tangent, mass, length, arc, blank] = points;
    const Numbers a1 = acceleration(time, x, v);
    const Numbers v2 = ahead(v, h / 2, a1);
    const Numbers a2 = acceleration(time + h / 2, ahead(x, h / 2, v), v2);
    const Numbers v3 = ahead(v, h / 2, a2);
    const Numbers a3 = acceleration(time + h / 2, ahead(x, h / 2, v2), v3);
    const Numbers v4 = ahead(v, h, a3);
    const Numbers a4 = acceleration(time + h, ahead(x, h, v3), v4);
    for (std::size_t i = 0; i < x.size(); ++i) {
      x[i] += h / 6 * (v[i] + 2 * v2[i] + 2 * v3[i] + v4[i]);
      v[i] += h / 6 * (a1[i] + 2 * a2[i] + 2 * a3[i] + a4[i]);
    }
  }

  std::vector<const Effect*> effects_;
};

/// A straight strand along x at height z, at rest: n points that share its length (m).
inline Cloud straight(std::size_t n, double length, double mass_per_length, double z) {
  Cloud strand(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double share = length / static_cast<double>(n);
    store3(Vec{(static_cast<double>(i) + 0.5) * share, 0, z}, &strand.x[3 * i]);
    store3(Vec{}, &strand.v[3 * i]);
    store3(Vec{1, 0, 0}, &strand.tangent[3 * i]);
    strand.length[i] = share;
    strand.arc[i] = (static_cast<double>(i) + 0.5) * share;
    strand.mass[i] = mass_per_length * share;
  }
  return strand;
}

}  // namespace tress::testing_support
