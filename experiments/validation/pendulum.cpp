#include "experiments/validation/pendulum.h"

#include <cmath>
#include <numbers>
#include <string>

#include "contract/input_error.h"
#include "experiments/validation/rods/motion.h"
#include "experiments/validation/rods/numerics.h"
#include "experiments/validation/rods/rod.h"
#include "experiments/validation/rods/signals.h"

namespace tress::experiments::validation {
namespace {

using std::numbers::pi;

constexpr double length = 0.1, radius = 1e-3;  // m
constexpr double hinge = length / 1000;        // m
constexpr double hinge_share = 0.0005;         // k over m g L/2
// rho g S L^3/EI = 0.5: it bends under its weight by a few thousandths of its length.
// Stiffer rods swing alike, but cost Newton more digits.
constexpr Material material{
    .density = 1300, .youngs_modulus = 1e8, .shear_modulus = 1e10};

struct Rod {
  double moment, inertia, stiffness;  // m g c (N m), I (kg m^2), k (N m)
};

Rod rod() {
  const double per_length = material.density * CrossSection{radius, radius}.area();
  // From the hinge's end to the tip, measured from the hinge's middle.
  const double from = hinge / 2, to = length - hinge / 2;
  return {per_length * earth_gravity * (to * to - from * from) / 2,
          per_length * (to * to * to - from * from * from) / 3,
          hinge_share * per_length * length * earth_gravity * length / 2};
}

Strand strand(int elements, double amplitude) {
  if (elements < 2) {
    throw InputError("one element cannot be a hinge and a rod", "pendulum",
                     "give 2 or more");
  }
  Strand strand =
      make_strand(material, {radius, radius}, {.elements = elements, .length = length},
                  uniform_shape({}));
  // k = EI/hinge, I = pi a^4/4.
  const double inertia = rod().stiffness * hinge / material.youngs_modulus;
  const double thin = std::pow(4 * inertia / pi, 0.25);
  for (int i = 0; i < elements; ++i) {
    Segment& segment = strand.segments[static_cast<std::size_t>(i)];
    segment.length = i == 0 ? hinge : (length - hinge) / (elements - 1);
    if (i == 0) segment.section = {thin, thin};
  }
  strand.root.frame = rotation({0, 1, 0}, -amplitude) * hanging_clamp();
  return strand;
}

/// Measures the period at the tip over three periods, by steps of 1/400 of one: (omega
/// h)^2 = 2.5e-4. Such steps do not resolve the stiff modes of a rigid rod, which bdf2
/// damps. The method implicit_midpoint does not damp them, and its Newton iteration then
/// fails for most models.
double swinging_period(const ModelTrial& trial) {
  const auto system =
      on_strand(trial.variant, strand(trial.elements, trial.parameter), weight());
  const double expected = pendulum_period(trial.parameter);
  return period(
      track("bdf2", *system, expected / 400, 3.3 * expected, place(*system, -1, 0)));
}

}  // namespace

double pendulum_period(double amplitude) {
  const Rod r = rod();
  // (m g c (1 - cos theta) + k (theta - a)^2/2)/I, without the cancellation.
  const auto potential = [&](double theta) {
    const double sine = std::sin(theta / 2), turn = theta - amplitude;
    return (2 * r.moment * sine * sine + r.stiffness / 2 * turn * turn) / r.inertia;
  };
  const double most = potential(amplitude);
  const double other = find_root([&](double theta) { return potential(theta) - most; },
                                 -1.1 * amplitude, 0);
  // T = 2 int dtheta/rate(theta) between the turning points; with theta = middle + half
  // sin phi the integrand is smooth and periodic, and the midpoint rule converges faster
  // than any power.
  const double middle = (amplitude + other) / 2, half = (amplitude - other) / 2;
  constexpr int points = 200;
  double sum = 0;
  for (int i = 0; i < points; ++i) {
    const double phi = ((i + 0.5) / points - 0.5) * pi;
    const double theta = middle + half * std::sin(phi);
    sum += half * std::cos(phi) / std::sqrt(2 * (most - potential(theta)));
  }
  return 2 * sum * pi / points;
}

std::vector<ValidationTest> pendulum_tests() {
  return {{
      .name = "pendulum",
      .what = "a stiff strand on a weak hinge swings as a rigid pendulum",
      .source =
          "Landau & Lifshitz 1976, section 32: (m g L/2 + k)/(m L^2/3), beyond small "
          "angles 4 K(sin(a/2)); by quadrature of the energy",
      .parameter = "amplitude (rad)",
      .quantity = "period (s)",
      .range = {1e-3, 2},
      .quick = {{0.05, 1}, {12}},
      .usual = {{0.05, 0.5, 1}, {12, 24}},
      .full = {{0.05, 0.25, 0.5, 0.75, 1}, {6, 12, 24, 48}},
      .tolerance = 0.01,
      .why = "frequencies are asked for within 1 %: masses in points at the ends of 11 "
             "segments have an inertia 1/(2 11^2) too large, 0.2 % of the period; the "
             "hinge may be wrong by its length, 0.05 %, and its stiffness, 0.03 %",
      .judged_from = 12,
      .claimed = {"super_helix", "super_clothoid", "articulated_chain", "der", "corde",
                  "xpbd_cosserat", "kirchhoff_nodal", "mass_spring",
                  "inextensible_strand"},
      .reference = pendulum_period,
      .measure = swinging_period,
  }};
}

}  // namespace tress::experiments::validation
