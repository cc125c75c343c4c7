#include <algorithm>
#include <cmath>

#include "contract/input_error.h"
#include "experiments/validation/rods/numerics.h"
#include "experiments/validation/rods/rod.h"
#include "experiments/validation/rods/statics.h"
#include "experiments/validation/test.h"

namespace tress::experiments::validation {
namespace {

/// An inextensible rope of length 1 between two ends at one height, `span` apart: z = a
/// cosh(x/a), 1 = 2 a sinh(span/(2 a)) [Leibniz, Huygens, Joh. Bernoulli 1691].
struct Catenary {
  double a;
  explicit Catenary(double span) {
    if (!(span > 0 && span < 1)) {
      throw InputError("no rope of this span", "test catenary",
                       "give the distance of the ends over the length, in (0, 1)");
    }
    a = find_root([span](double x) { return 2 * x * std::sinh(span / (2 * x)) - 1; },
                  span / 100, 100);
  }
  double slope_at_end() const { return 1 / (2 * a); }  // sinh(x/a)
  double sag() const { return a * (std::sqrt(1 + slope_at_end() * slope_at_end()) - 1); }
  /// Curvature at s from an end: the tangent of the slope angle is (s - 1/2)/a.
  double curvature(double s) const {
    const double t = (s - 0.5) / a;
    return 1 / (a * (1 + t * t));
  }
};

double sag(double span) { return Catenary(span).sag(); }

constexpr double rope_length = 1;

/// Returns the Gamma at which EI/(H a^2) = 1/(Gamma a^3) is a hundredth at most: the
/// relative effect of EI at the lowest point, with H the tension there. As in a hanging
/// chain, the effect of EI at an end reaches about Gamma^(-1/2), and the clamp is aligned
/// with the rope. Weight stretches the rope by Gamma r^2/(4 L^2), 4e-5 to 4e-4.
double rope_gamma(const Catenary& rope) {
  return std::max(1e5, 100 / std::pow(rope.a, 3));
}

/// Starts from the shape of the rope, hanging between its clamp and its tip, which is
/// held in place. The lowest point is the middle node; the number of elements is even.
double measure_sag(const ModelTrial& trial) {
  if (trial.elements % 2 != 0) {
    throw InputError("no node in the middle", "test catenary",
                     "give an even number of elements");
  }
  const Catenary rope(trial.parameter);
  TestRod rod{.length = rope_length};
  // The rope turns up: about e1 the curvature is negative.
  rod.initial = [rope](double s) { return Vec{0, -rope.curvature(s / rope_length), 0}; };
  const double down = std::atan(rope.slope_at_end());
  const Frame clamp = rotation({0, 1, 0}, down);
  Statics statics(trial.variant, rod.strand(trial.elements, clamp),
                  {0, 0, -rod.gravity(rope_gamma(rope))},
                  {.along = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                   .place = {trial.parameter * rod.length, 0, 0}});
  statics.follow(1e-3, 1);
  const std::vector<double> x = statics.points();
  const auto middle = static_cast<std::size_t>(trial.elements) / 2;
  return -x[3 * middle + 2] / rod.length;
}

}  // namespace

/// A strand whose weight dominates its stiffness, held at both ends.
std::vector<ValidationTest> hanging_tests() {
  return {{
      .name = "catenary",
      .what = "rope held at both ends, EI/(H a^2) below 0.01",
      .source = "Joh. Bernoulli 1691",
      .parameter = "distance of the ends over the length",
      .quantity = "sag over the length",
      .range = {0.2, 0.99},
      .quick = {{0.5, 0.9}, {20, 40}},
      .usual = {{0.2, 0.5, 0.8, 0.95}, {10, 20, 40, 80}},
      .full = {{0.2, 0.35, 0.5, 0.65, 0.8, 0.9, 0.95, 0.98}, {10, 20, 40, 80}},
      .tolerance = 0.005,
      .why = "0.5 % is wanted of a strand of negligible EI; below a span of 0.2 the bend "
             "is as short as an element",
      .judged_from = 40,
      .claimed = {"super_helix", "super_clothoid", "der", "corde", "dynamic_spline"},
      .reference = sag,
      .measure = measure_sag,
  }};
}

}  // namespace tress::experiments::validation
