#include "math/helix.h"

#include <cmath>

namespace tress::helix {

/// S and A from the half angle, free of cancellation; then successive derivatives of w^2
/// A = 1 - cos ws and w^2 B = s - S, with S'(w)/w = B - s A:
///     w^2 A1 = s S - 2 A,  w^2 A2 = s S1 - 4 A1,  w^2 A3 = s S2 - 6 A2
///     w^2 B1 = -S1 - 2 B,  w^2 B2 = -S2 - 4 B1,   w^2 B3 = -S3 - 6 B2
/// S1 = B - s A, S2 = B1 - s A1, S3 = B2 - s A2
HelixFunctions<double> closed_forms(double s, double x2) noexcept {
  const double half = 0.5 * std::sqrt(x2) * s;
  const double sine = std::sin(half), cosine = std::cos(half);
  const double over = 1 / x2;
  HelixFunctions<double> f;
  f.S = s * (sine * cosine / half);
  f.A = 2 * sine * sine * over;
  f.B = (s - f.S) * over;
  const double S1 = f.B - s * f.A;
  f.A1 = (s * f.S - 2 * f.A) * over;
  f.B1 = -(S1 + 2 * f.B) * over;
  const double S2 = f.B1 - s * f.A1;
  f.A2 = (s * S1 - 4 * f.A1) * over;
  f.B2 = -(S2 + 4 * f.B1) * over;
  const double S3 = f.B2 - s * f.A2;
  f.A3 = (s * S2 - 6 * f.A2) * over;
  f.B3 = -(S3 + 6 * f.B2) * over;
  return f;
}

}  // namespace tress::helix
