#pragma once

#include <algorithm>

#include "models/maximal/elasticity.h"

/// Energies that are sums of squares of strains. A `Part` of a strand is a kernel over
/// few coordinates x:
///
///     static constexpr int strains, coordinates;
///     double stiffness[strains], friction[strains];
///     template <class T> void strain(const T* x, T* s) const;
///     void gradient(const double* x, double (&g)[strains][coordinates]) const;
///     /// h += sum_k stress_k d^2 s_k/dx^2
///     void add_second(const double* x, const double* stress,
///                     double (&h)[coordinates][coordinates]) const;
namespace tress::models {

/// sum k s^2/2.
template <class Part, class T>
T strain_energy(const Part& part, const T* x) {
  T s[Part::strains];
  part.strain(x, s);
  T sum(0);
  for (int k = 0; k < Part::strains; ++k) {
    sum = sum + T(part.stiffness[k] / 2) * s[k] * s[k];
  }
  return sum;
}

/// A part at x, moving with `rate`.
template <class Part>
struct Strained {
  static constexpr int strains = Part::strains, size = Part::coordinates;

  Strained(const Part& of_part, const double* at, const double* moving)
      : part(of_part), x(at), rate(moving) {
    part.strain(x, value);
    part.gradient(x, gradient);
    for (int k = 0; k < strains; ++k) {
      speed[k] = 0;
      for (int i = 0; i < size; ++i) speed[k] += gradient[k][i] * rate[i];
      stress[k] = part.stiffness[k] * value[k] + part.friction[k] * speed[k];
      second_stress[k] = stress[k];
    }
  }

  /// f += G^T stress.
  void add_force(double* f) const {
    for (int k = 0; k < strains; ++k) {
      for (int i = 0; i < size; ++i) f[i] += stress[k] * gradient[k][i];
    }
  }

  /// The elastic stresses in the tangent's terms of second order come from there, where
  /// the part is at x0 (see StressForm).
  void take_stresses(const StressOrigin& origin, const double* x0) {
    double value0[strains], gradient0[strains][size];
    part.strain(x0, value0);
    part.gradient(x0, gradient0);
    for (int k = 0; k < strains; ++k) {
      double change = 0;
      for (int i = 0; i < size; ++i) change += gradient0[k][i] * (x[i] - x0[i]);
      second_stress[k] += origin.stress(part.stiffness[k], value0[k], change) -
                          part.stiffness[k] * value[k];
    }
  }

  /// h = pos df/dx + vel df/d(rate).
  void tangent(double pos, double vel, double (&h)[size][size]) const {
    for (auto& row : h) std::ranges::fill(row, 0.0);
    double weighted[strains];
    for (int k = 0; k < strains; ++k) weighted[k] = pos * second_stress[k];
    part.add_second(x, weighted, h);
    for (int k = 0; k < strains; ++k) {
      double by[size];  // pos d stress_k/dx + vel d stress_k/d(rate)
      const double factor = pos * part.stiffness[k] + vel * part.friction[k];
      for (int j = 0; j < size; ++j) by[j] = factor * gradient[k][j];
      if (part.friction[k] != 0) add_slope_of_speed(k, pos * part.friction[k], by);
      for (int i = 0; i < size; ++i) {
        for (int j = 0; j < size; ++j) h[i][j] += gradient[k][i] * by[j];
      }
    }
  }

  /// W, <= 0.
  double friction_power() const {
    double sum = 0;
    for (int k = 0; k < strains; ++k) sum -= part.friction[k] * speed[k] * speed[k];
    return sum;
  }

  const Part& part;
  const double *x, *rate;
  double value[strains], gradient[strains][size], speed[strains], stress[strains];
  double second_stress[strains];  // of the tangent's terms of second order

 private:
  void add_slope_of_speed(int k, double factor, double (&by)[size]) const {
    double only[strains] = {}, second[size][size] = {};
    only[k] = factor;
    part.add_second(x, only, second);
    for (int i = 0; i < size; ++i) {
      for (int j = 0; j < size; ++j) by[j] += second[i][j] * rate[i];
    }
  }
};

/// The constants of a part as a block over these coordinates.
template <class Part>
ComplianceForm::Block strain_block(const Part& part, std::vector<int> coordinates) {
  ComplianceForm::Block block{std::move(coordinates), Part::strains, {}, {}};
  for (std::size_t k = 0; k < Part::strains; ++k) {
    block.alpha[k] = 1 / part.stiffness[k];
    block.friction[k] = part.friction[k];
  }
  return block;
}

}  // namespace tress::models
