#pragma once

namespace tress::integrators {

/// The two-step backward differentiation formula with variable steps,
///
///     y_{n+1} = c0 y_n - c1 y_{n-1} + bh y'_{n+1},
///
/// with w = h/h_previous: b = (1 + w)/(1 + 2w), c0 = (1 + w)^2/(1 + 2w), c1 = w^2/(1 +
/// 2w). w = 0 is backward Euler. [Hairer, Norsett, Wanner I, III.5]
struct Bdf2Formula {
  double c0, c1, bh;  // coefficients of the formula; bh in s

  /// Computes the coefficients for a step of h (s), w times as long as the one before.
  Bdf2Formula(double h, double w)
      : c0((1 + w) * (1 + w) / (1 + 2 * w)),
        c1(w * w / (1 + 2 * w)),
        bh((1 + w) / (1 + 2 * w) * h) {}
};

}  // namespace tress::integrators
