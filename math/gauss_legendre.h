#pragma once

#include <vector>

namespace tress {

/// One point of a quadrature rule.
struct QuadraturePoint {
  double at, weight;  // position in the interval, and weight
};

/// Gauss-Legendre over [0, length] with `count` points (> 0): exact for polynomials of
/// degree 2 count - 1.
std::vector<QuadraturePoint> gauss_legendre(int count, double length);

}  // namespace tress
