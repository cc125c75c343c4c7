#pragma once

#include <gtest/gtest.h>

#include "models/elements/rod_element.h"

namespace tress::testing_support {

/// A law without the derivatives that it states by hand.
template <models::RodLaw Law>
struct StrainsOnly {
  static constexpr int nodes = Law::nodes, strains = Law::strains;
  Law law;

  template <class T>
  void strain(const Vec3<T>* x, T* s) const {
    law.strain(x, s);
  }
};

/// Largest difference of the derivatives of a law (rod_element.h) from those by dual
/// numbers, over the largest derivative: of first and second order, at positions x.
template <models::RodLaw Law>
std::array<double, 2> law_derivative_error(const Law& law, const double* x) {
  constexpr int n = 3 * Law::nodes, strains = Law::strains;
  const models::LawPart<Law> by_hand{law};
  const models::LawPart<StrainsOnly<Law>> by_duals{{law}};
  double g[2][strains][n], second[2][n][n] = {}, stress[strains];
  for (int k = 0; k < strains; ++k) stress[k] = k % 2 == 0 ? 1 : -0.5;
  by_hand.gradient(x, g[0]);
  by_duals.gradient(x, g[1]);
  by_hand.add_second(x, stress, second[0]);
  by_duals.add_second(x, stress, second[1]);
  const auto error = [](const double* a, const double* b, int count) {
    double size = 0, most = 0;
    for (int i = 0; i < count; ++i) {
      size = std::max(size, std::abs(b[i]));
      most = std::max(most, std::abs(a[i] - b[i]));
    }
    return most / size;
  };
  return {error(&g[0][0][0], &g[1][0][0], strains * n),
          error(&second[0][0][0], &second[1][0][0], n * n)};
}

}  // namespace tress::testing_support
