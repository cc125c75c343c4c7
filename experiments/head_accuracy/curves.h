#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "math/vec3.h"

namespace tress::experiments::head_accuracy {

/// Hairs at some instants, each as points at equal shares of its length, the root first.
struct HairCurves {
  std::size_t hairs = 0;
  int elements = 0;                    // of each, between its points
  std::vector<std::vector<double>> x;  // of each instant: hair after hair, m

  /// The point of a hair at this share of its length: a cubic through the four nearest
  /// points. Of a curl of curvature c between points d apart it is off by less than
  /// 0.04 c^3 d^4. Needs three elements.
  Vec at(std::size_t instant, std::size_t hair, double share) const;
};

/// Returns 2 fine - coarse, in which the error proportional to the step cancels if the
/// step of `fine` is half that of `coarse`.
HairCurves extrapolated_in_step(HairCurves fine, const HairCurves& coarse);
/// Returns fine + (fine - coarse)/3, in which the error proportional to the square of
/// the element length cancels if elements of `fine` are half as long [Richardson].
HairCurves extrapolated_in_elements(HairCurves fine, const HairCurves& coarse);

/// Distances of hairs from those of a reference, root mean square over instants and over
/// the length (trapezoidal rule), by the length of each hair.
class HairErrors {
 public:
  HairErrors(const HairCurves& reference, std::span<const double> lengths)
      : reference_(reference), lengths_(lengths), sums_(reference.hairs) {}

  /// Points of one hair at an instant, the root first.
  void add(std::size_t instant, std::size_t hair, std::span<const Vec> points);
  /// Adds several hairs, one after the other.
  void add(std::size_t instant, std::span<const std::size_t> hairs,
           std::span<const Vec> points);
  /// Returns the error of one hair after all its instants.
  double of(std::size_t hair) const;

 private:
  struct Sum {
    double squares = 0;
    int instants = 0;
  };
  const HairCurves& reference_;
  std::span<const double> lengths_;
  std::vector<Sum> sums_;
};

/// Errors over hairs: their mean, what 95 of 100 do not exceed, and the largest.
struct Spread {
  double mean = 0, p95 = 0, largest = 0;
};
/// The weight of an error is the number of hairs that it represents.
Spread spread(std::span<const double> errors, std::span<const double> weights);
/// Each stands for one.
Spread spread(std::span<const double> errors);

}  // namespace tress::experiments::head_accuracy
