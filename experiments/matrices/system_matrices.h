#pragma once

#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "experiments/matrices/matrix_market.h"
#include "experiments/numerics/dense_form.h"
#include "simulation/scene/scene.h"

namespace tress::experiments::matrices {

using simulation::Scene;

/// One system at an instant of its scene.
struct Moment {
  std::unique_ptr<System> system;
  Instant at;
  std::vector<double> multipliers;  // of its constraints
};

/// Runs the scene to `time` (s) with its own settings; the system is the strand with
/// this index, or the mechanism. Effects between strands act on the motion, and are no
/// part of the system. Throws InputError where there is no such strand, and
/// std::runtime_error where the scene does not get there or its accelerations are not
/// determined.
Moment moment(const Scene& scene, std::size_t strand, double time);

/// A matrix of r(t, q, v, a) - G^T lambda = 0, with what it is.
struct Named {
  std::string_view name, what;
  Matrix matrix;
  bool analytic = true;  // false: by differences of the residual
};

/// M = dr/da, D = dr/dv, K = dr/dq, the step's M + h D + h^2 K of backward Euler, and
/// with constraints G = dg/dq and C = d(G^T lambda)/dq. From the sparse form where the
/// system has one, so with the Jacobian that the scene chooses; else of the residual
/// itself.
std::vector<Named> matrices_of(Moment& moment, double h);

/// Spectrum of a square matrix. O(n^3).
struct Spectrum {
  double least = 0, largest = 0, imaginary = 0;  // eigenvalues: real parts, largest |Im|
  double condition = 0;  // |A|_1 |A^-1|_1; infinity: beyond 1/epsilon
};
Spectrum spectrum(const Matrix& matrix);

/// |A - A^T| over |A|, of largest entries.
double asymmetry(const Matrix& matrix);

/// Least and largest sqrt(Re lambda)/(2 pi) (Hz) of K x = lambda M x with a positive real
/// part; NaN where there is none. O(n^3).
std::pair<double, double> frequencies_hz(const Matrix& mass, const Matrix& stiffness);

}  // namespace tress::experiments::matrices
