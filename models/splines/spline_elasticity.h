#pragma once

#include <array>

#include "models/maximal/elasticity.h"

namespace tress::models {

/// Energy (J) of one quadrature point of dynamic_spline.cpp: a = r', b = r'',
///
///     stretch (|a| - length)^2/2 + bend |a x b|^2/(2 |a|^4).
template <class T>
T spline_energy(double stretch, double length, double bend, const Vec3<T>& a,
                const Vec3<T>& b) {
  using std::sqrt;
  const T square = dot(a, a);
  const T longer = sqrt(square) - T(length);
  const Vec3<T> turn = cross(a, b);
  return T(stretch / 2) * longer * longer +
         T(bend / 2) * dot(turn, turn) / (square * square);
}

/// Sum of weights times the four control points of a span, `x` the first of them.
inline Vec of_controls(const std::array<double, 4>& weight, const double* x) {
  Vec total;
  for (std::size_t k = 0; k < 4; ++k) total = total + weight[k] * load3(x + 3 * k);
  return total;
}

/// Stretching and bending of a cubic spline, summed over quadrature points.
class SplineElasticity final : public Elasticity {
 public:
  /// Quadrature point.
  struct Point {
    std::size_t span;                     // its control points are span, ..., span + 3
    std::array<double, 4> first, second;  // derivatives of their weights
    double stretch, bend;                 // EA and EI times the point's length
    double length = 1;                    // |r'| at rest
  };

  /// `points` in the order of their spans.
  SplineElasticity(std::size_t spans, std::vector<Point> points)
      : spans_(spans), points_(std::move(points)) {}

  std::vector<std::vector<int>> groups() const override;
  void add_force(const Placement& p, InOut f) noexcept override;
  void add_tangent(const Placement& p, double pos, double vel,
                   GroupSum& s) noexcept override;
  double energy(const Placement& p) noexcept override;
  double power(const Placement&) noexcept override { return 0; }
  double stretch(const Placement& p) noexcept override;
  std::optional<EndTurn> end_turn(bool) const override { return EndTurn{}; }
  bool takes_stresses() const override { return true; }

 private:
  std::size_t spans_;
  std::vector<Point> points_;
};

}  // namespace tress::models
