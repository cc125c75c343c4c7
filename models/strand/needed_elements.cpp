#include "models/strand/needed_elements.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tress::models {
namespace {

constexpr double most_winding = 1.5;  // rad, of an element
constexpr int samples = 64;           // of a natural shape

/// Twist and curvature of a natural shape along a strand, and how they vary.
struct Course {
  double largest = 0, variation = 0, square = 0;  // 1/m, 1/m, 1/m: int k^2 ds
  Vec mean;                                       // 1/m

  explicit Course(const UncutStrand& strand) {
    Vec before;
    for (int i = 0; i < samples; ++i) {
      const Vec k = strand.natural(strand.length * (i + 0.5) / samples);
      largest = std::max(largest, norm(k));
      square += strand.length / samples * dot(k, k);
      mean = mean + (1.0 / samples) * k;
      if (i > 0) variation += norm(k - before);
      before = k;
    }
  }
};

double turns_of(const UncutStrand& strand, const Vec& mean) {
  return strand.length * norm(mean) / (2 * std::numbers::pi);
}

/// Between the way a strand leaves its root and the way down: the axis of a coil stands
/// at an angle to its tangent, on any side.
double angle_to_fall(const UncutStrand& strand, const Vec& mean) {
  const double tangent = std::acos(std::clamp(-strand.tangent.z, -1.0, 1.0)),
               axis = std::atan2(std::hypot(mean.y, mean.z), std::abs(mean.x));
  return std::min(std::numbers::pi,
                  tangent + std::min(1.0, turns_of(strand, mean)) * axis);
}

double sag(const UncutStrand& strand, const Vec& mean) {
  const double length = strand.length, pull = strand.weight * length / strand.stiffness,
               angle = angle_to_fall(strand, mean);
  return std::min(pull * length / 2, 2 * std::sqrt(pull) * std::sin(angle / 2)) +
         norm(mean) * std::min(pull * length * length / 6, angle);
}

double coil(const UncutStrand& strand, const Vec& mean) {
  const double bend = std::hypot(mean.y, mean.z), winding = norm(mean);
  if (!(winding > 0)) return 0;
  const double radius = bend / (winding * winding),
               more = strand.weight * strand.length * radius / (2 * strand.stiffness);
  return 4 * turns_of(strand, mean) * std::min(more, bend);
}

}  // namespace

int elements_for(const UncutStrand& strand, double tolerance, int most) {
  const Course course(strand);
  const double natural = std::min(course.variation, 2 * course.largest + course.square),
               all = natural + sag(strand, course.mean) + coil(strand, course.mean),
               needed = std::max(strand.length * std::sqrt(all / (12 * tolerance)),
                                 strand.length * course.largest / most_winding);
  int power = 2;
  while (power < most) {
    for (const int step : {power, power + power / 2}) {
      if (step >= needed && step < most) return step;
    }
    power *= 2;
  }
  return most;
}

}  // namespace tress::models
