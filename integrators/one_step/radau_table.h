#pragma once

#include <array>
#include <cstddef>

namespace tress::integrators {

/// Radau IIA with three stages, and the triangular matrix with which its stages are
/// solved.
struct RadauTable {
  static constexpr std::size_t stages = 3;  // number of stages
  /// A matrix over the stages, by rows.
  using Matrix = std::array<std::array<double, stages>, stages>;
  std::array<double, stages> c{};  // times of the stages over h
  Matrix a{};                      // coefficients; the last row leads to the new state
  Matrix t{};                      // lower triangular, with one diagonal entry

  /// Returns the diagonal entry of t.
  constexpr double gamma() const { return t[0][0]; }
};

/// Returns the coefficients. [Hairer, Wanner 1996, Solving ODEs II, table IV.5.6]
///
/// The triangular T minimises the largest spectral radius of (I - z T)^-1 z (A - T) over
/// Re z <= 0, 0.242 near |z| = 5. That is the rate at which the iteration of RadauStages
/// converges for linear equations. Crout's triangular factor of A, whose three diagonal
/// entries differ and need three matrices, has 0.372 [van der Houwen, de Swart 1997, SIAM
/// J. Sci. Comput. 18, 41].
constexpr RadauTable radau_table() {
  constexpr double r6 = 2.449489742783178;  // sqrt 6
  return {.c = {(4 - r6) / 10, (4 + r6) / 10, 1},
          .a = {{{(88 - 7 * r6) / 360, (296 - 169 * r6) / 1800, (-2 + 3 * r6) / 225},
                 {(296 + 169 * r6) / 1800, (88 + 7 * r6) / 360, (-2 - 3 * r6) / 225},
                 {(16 - r6) / 36, (16 + r6) / 36, 1. / 9}}},
          .t = {{{0.2632}, {0.4068, 0.2632}, {0.3724, 0.3843, 0.2632}}}};
}

}  // namespace tress::integrators
