#include "models/splines/spline_elasticity.h"

#include <algorithm>
#include <cmath>

namespace tress::models {
namespace {

using Point = SplineElasticity::Point;

/// Energy as a function of A = a . a, B = b . b and C = a . b, and its derivatives:
/// stretch (sqrt A - l)^2/2 + bend (B/A - C^2/A^2)/2. The stretch is given by its
/// tension.
struct Slopes {
  Slopes(const Point& point, const Vec& a, const Vec& b, double tension) {
    const double square = dot(a, a), along = dot(a, b) / square;
    const double curved = dot(b, b) / square, length = std::sqrt(square);
    const double bend = point.bend / square;
    A = tension / (2 * length) + bend * (along * along - curved / 2);
    B = bend / 2;
    C = -bend * along;
    AA = (point.stretch - tension / length) / (4 * square) +
         bend / square * (curved - 3 * along * along);
    AB = -bend / (2 * square);
    AC = 2 * bend * along / square;
    CC = -bend / square;
  }
  double A, B, C, AA, AB, AC, CC;
};

double tension_at(const Point& point, const Vec& a) {
  return point.stretch * (norm(a) - point.length);
}

/// In the tangent's terms of second order.
double tension_from(const Point& point, const Vec& a, const StressOrigin& origin) {
  const Vec a0 = of_controls(point.first, &origin.z[3 * point.span]);
  const double length = norm(a0);
  return origin.stress(point.stretch, length - point.length, dot(a0, a - a0) / length);
}

}  // namespace

std::vector<std::vector<int>> SplineElasticity::groups() const {
  std::vector<std::vector<int>> all(spans_);
  for (std::size_t i = 0; i < spans_; ++i) {
    for (int k = 0; k < 12; ++k) all[i].push_back(static_cast<int>(3 * i) + k);
  }
  return all;
}

void SplineElasticity::add_force(const Placement& p, InOut f) noexcept {
  for (const Point& point : points_) {
    const Vec a = of_controls(point.first, &p.z[3 * point.span]);
    const Vec b = of_controls(point.second, &p.z[3 * point.span]);
    const Slopes d(point, a, b, tension_at(point, a));
    const Vec by_a = 2 * d.A * a + d.C * b, by_b = 2 * d.B * b + d.C * a;
    for (std::size_t k = 0; k < 4; ++k) {
      double* force = &f[3 * (point.span + k)];
      store3(load3(force) + point.first[k] * by_a + point.second[k] * by_b, force);
    }
  }
}

void SplineElasticity::add_tangent(const Placement& p, double pos, double,
                                   GroupSum& s) noexcept {
  auto point = points_.begin();
  for (std::size_t span = 0; span < spans_; ++span) {
    double h[12][12] = {};
    for (; point != points_.end() && point->span == span; ++point) {
      double a[3], b[3];
      store3(of_controls(point->first, &p.z[3 * span]), a);
      store3(of_controls(point->second, &p.z[3 * span]), b);
      const double tension = p.origin == nullptr
                                 ? tension_at(*point, load3(a))
                                 : tension_from(*point, load3(a), *p.origin);
      const Slopes d(*point, load3(a), load3(b), tension);
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
          const double one = i == j ? pos : 0;
          const double aa =
              2 * d.A * one + pos * (4 * d.AA * a[i] * a[j] + d.CC * b[i] * b[j] +
                                     2 * d.AC * (a[i] * b[j] + b[i] * a[j]));
          const auto ab = [&](int of_a, int of_b) {
            return d.C * one + pos * (4 * d.AB * a[of_a] * b[of_b] +
                                      2 * d.AC * a[i] * a[j] + d.CC * b[of_a] * a[of_b]);
          };
          const double bb = 2 * d.B * one + pos * d.CC * a[i] * a[j];
          for (std::size_t k = 0; k < 4; ++k) {
            for (std::size_t l = 0; l < 4; ++l) {
              const auto row = 3 * k + static_cast<std::size_t>(i);
              h[row][3 * l + static_cast<std::size_t>(j)] +=
                  point->first[k] * point->first[l] * aa +
                  point->first[k] * point->second[l] * ab(i, j) +
                  point->second[k] * point->first[l] * ab(j, i) +
                  point->second[k] * point->second[l] * bb;
            }
          }
        }
      }
    }
    s.add(span, &h[0][0]);
  }
}

double SplineElasticity::energy(const Placement& p) noexcept {
  double total = 0;
  for (const Point& point : points_) {
    total += spline_energy(point.stretch, point.length, point.bend,
                           of_controls(point.first, &p.z[3 * point.span]),
                           of_controls(point.second, &p.z[3 * point.span]));
  }
  return total;
}

double SplineElasticity::stretch(const Placement& p) noexcept {
  double most = 0;
  for (const Point& point : points_) {
    const Vec a = of_controls(point.first, &p.z[3 * point.span]);
    most = std::max(most, std::abs(norm(a) / point.length - 1));
  }
  return most;
}

}  // namespace tress::models
