#pragma once

#include <algorithm>
#include <type_traits>
#include <utility>

#include "contract/forms/compliance_form.h"
#include "models/maximal/elasticity.h"

/// Energies that are sums of squares of strains. A `Part` of a strand is a kernel over
/// few coordinates x, in numbers of type T, double or a pack:
///
///     static constexpr int strains, coordinates;
///     T stiffness[strains], friction[strains];
///     template <class U> void strain(const U* x, U* s) const;
///     void gradient(const T* x, T (&g)[strains][coordinates]) const;
///     /// h += sum_k stress_k d^2 s_k/dx^2
///     void add_second(const T* x, const T* stress,
///                     T (&h)[coordinates][coordinates]) const;
///
/// and, needed where T is a pack, which of its strains have friction, the first ones, and
/// the derivatives of their rates by x:
///
///     static constexpr int with_friction;
///     void slope_of_speed(const T* x, const T* rate,
///                         T (&g)[with_friction][coordinates]) const;
namespace tress::models {

/// sum k s^2/2.
template <class Part, class T>
T strain_energy(const Part& part, const T* x) {
  T s[Part::strains];
  part.strain(x, s);
  T sum(0);
  for (int k = 0; k < Part::strains; ++k) {
    sum = sum + T(0.5) * T(part.stiffness[k]) * s[k] * s[k];
  }
  return sum;
}

/// A part at x, moving with `rate`.
template <class Part>
struct Strained {
  /// Number of strains, and of coordinates in x.
  static constexpr int strains = Part::strains, size = Part::coordinates;
  /// Scalar: a number, or a pack of SIMD lanes.
  using T = std::remove_cvref_t<decltype(std::declval<Part>().stiffness[0])>;

  /// Evaluates strains, stresses and rates of the part.
  Strained(const Part& of_part, const T* at, const T* moving)
      : part(of_part), x(at), rate(moving) {
    part.strain(x, value);
    part.gradient(x, gradient);
    for (int k = 0; k < strains; ++k) {
      speed[k] = T(0);
      for (int i = 0; i < size; ++i) speed[k] += gradient[k][i] * rate[i];
      stress[k] = part.stiffness[k] * value[k] + part.friction[k] * speed[k];
      second_stress[k] = stress[k];
    }
  }

  /// f += G^T stress.
  void add_force(T* f) const {
    for (int k = 0; k < strains; ++k) {
      for (int i = 0; i < size; ++i) f[i] += stress[k] * gradient[k][i];
    }
  }

  /// The elastic stresses in the tangent's terms of second order come from there, where
  /// the part is at x0 (see StressForm).
  void take_stresses(const StressOrigin& origin, const double* x0) {
    double value0[strains], gradient0[strains][size], elastic[strains];
    part.strain(x0, value0);
    part.gradient(x0, gradient0);
    for (int k = 0; k < strains; ++k) {
      double change = 0;
      for (int i = 0; i < size; ++i) change += gradient0[k][i] * (x[i] - x0[i]);
      elastic[k] = origin.stress(part.stiffness[k], value0[k], change);
    }
    take_stresses(elastic);
  }
  /// Replaces the elastic stresses of second-order terms.
  void take_stresses(const T* elastic) {
    for (int k = 0; k < strains; ++k) {
      second_stress[k] += elastic[k] - part.stiffness[k] * value[k];
    }
  }

  /// h = pos df/dx + vel df/d(rate).
  void tangent(const T& pos, const T& vel, T (&h)[size][size]) const {
    for (auto& row : h) std::ranges::fill(row, T(0));
    T weighted[strains], by[strains][size];  // pos d stress/dx + vel d stress/d(rate)
    for (int k = 0; k < strains; ++k) {
      weighted[k] = pos * second_stress[k];
      const T factor = pos * part.stiffness[k] + vel * part.friction[k];
      for (int j = 0; j < size; ++j) by[k][j] = factor * gradient[k][j];
    }
    part.add_second(x, weighted, h);
    add_slopes_of_speed(pos, by);
    for (int i = 0; i < size; ++i) {
      for (int j = 0; j < size; ++j) {
        T sum = gradient[0][i] * by[0][j];
        for (int k = 1; k < strains; ++k) sum += gradient[k][i] * by[k][j];
        h[i][j] += sum;
      }
    }
  }

  /// Returns the power of friction, W, <= 0.
  double friction_power() const {
    double sum = 0;
    for (int k = 0; k < strains; ++k) sum -= part.friction[k] * speed[k] * speed[k];
    return sum;
  }

  const Part& part;   // the part
  const T *x, *rate;  // coordinates and their rates
  /// Strains, their derivatives, rates and stresses.
  T value[strains], gradient[strains][size], speed[strains], stress[strains];
  T second_stress[strains];  // of the tangent's terms of second order

 private:
  void add_slopes_of_speed(const T& pos, T (&by)[strains][size]) const {
    if constexpr (requires { Part::with_friction; }) {
      if constexpr (Part::with_friction > 0) {
        T slope[Part::with_friction][size];
        part.slope_of_speed(x, rate, slope);
        for (int k = 0; k < Part::with_friction; ++k) {
          const T factor = pos * part.friction[k];
          for (int j = 0; j < size; ++j) by[k][j] += factor * slope[k][j];
        }
      }
    } else {
      for (int k = 0; k < strains; ++k) {
        if (part.friction[k] == 0) continue;
        double only[strains] = {}, second[size][size] = {};
        only[k] = pos * part.friction[k];
        part.add_second(x, only, second);
        for (int i = 0; i < size; ++i) {
          for (int j = 0; j < size; ++j) by[k][j] += second[i][j] * rate[i];
        }
      }
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
