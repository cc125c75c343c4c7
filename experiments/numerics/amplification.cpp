#include "experiments/numerics/amplification.h"

#include <cmath>

#include "experiments/numerics/dense_algebra.h"

namespace tress::experiments {
namespace {

double spectral_radius(const Eigen::MatrixXd& step) {
  return eigenvalues(step).cwiseAbs().maxCoeff();
}

/// (C, h C')' = h A (C, h C'), with a = alpha h^2 and b = beta h.
Eigen::Matrix2d generator(double a, double b) {
  Eigen::Matrix2d m;
  m << 0, 1, -a, -b;
  return m;
}

/// v+ = v - a C - b v, C+ = C + v+.
Eigen::Matrix2d symplectic_euler(double a, double b) {
  Eigen::Matrix2d m;
  m << 1 - a, 1 - b, -a, 1 - b;
  return m;
}

/// State (C, v, w): C+ = C + v + w/2, w+ = -a C+ - b (v + w), v+ = v + (w + w+)/2.
Eigen::Matrix3d velocity_verlet(double a, double b) {
  const Eigen::RowVector3d position(1, 1, 0.5);
  const Eigen::RowVector3d predicted(0, 1, 1);
  const Eigen::RowVector3d acceleration = -a * position - b * predicted;
  Eigen::Matrix3d m;
  m << position, Eigen::RowVector3d(0, 1, 0.5) + acceleration / 2, acceleration;
  return m;
}

/// The exponential series to fourth order.
Eigen::Matrix2d rk4(double a, double b) {
  const Eigen::Matrix2d g = generator(a, b), i = Eigen::Matrix2d::Identity();
  return i + g * (i + g / 2 * (i + g / 3 * (i + g / 4)));
}

}  // namespace

std::optional<double> amplification(std::string_view integrator, double omega_h,
                                    double zeta) {
  const double a = omega_h * omega_h;
  const double b = 2 * zeta * omega_h;
  if (integrator == "explicit_euler") {
    return spectral_radius(Eigen::Matrix2d::Identity() + generator(a, b));
  }
  if (integrator == "symplectic_euler") return spectral_radius(symplectic_euler(a, b));
  if (integrator == "velocity_verlet") return spectral_radius(velocity_verlet(a, b));
  if (integrator == "rk4") return spectral_radius(rk4(a, b));
  return {};
}

std::optional<double> largest_stable_omega_h(std::string_view integrator, double zeta) {
  // A double root on the unit circle is computed with a radius up to one plus sqrt(eps).
  constexpr double on_the_circle = 1 + 1e-7;
  // The scan starts below every limit of interest, in steps finer than any island.
  constexpr double first = 1e-4, last = 1e3, factor = 1.01;
  const auto stable = [&](double omega_h) {
    return *amplification(integrator, omega_h, zeta) <= on_the_circle;
  };
  if (!amplification(integrator, first, zeta)) return {};
  double low = first;
  if (!stable(low)) return 0.0;
  while (low < last && stable(low * factor)) low *= factor;
  double high = low * factor;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (stable(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace tress::experiments
