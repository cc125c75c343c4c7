#include <cmath>
#include <stdexcept>

#include "experiments/validation/rods/beam_modes.h"
#include "experiments/validation/rods/rod.h"
#include "experiments/validation/rods/statics.h"
#include "experiments/validation/test.h"

namespace tress::experiments::validation {
namespace {

constexpr std::string_view one_per_cent = "1 % is wanted";

/// Bending modes of a round straight strand come in pairs, one in each plane.
double bending_mode(Statics& statics, int mode) {
  const auto at = static_cast<std::size_t>(2 * (mode - 1));
  return std::sqrt(statics.motions().at(at).square);
}

double measure_beam(const ModelTrial& trial) {
  const TestRod rod;
  Statics statics(trial.variant, rod.strand(trial.elements, horizontal_clamp()), {});
  statics.relax(1);
  return bending_mode(statics, static_cast<int>(trial.parameter)) / rod.rate();
}

double measure_heavy_rod(const ModelTrial& trial) {
  const TestRod rod;
  const double gamma = trial.parameter;
  Statics statics(trial.variant, rod.strand(trial.elements, hanging_clamp()),
                  {0, 0, -rod.gravity(gamma)});
  statics.relax(1);
  return bending_mode(statics, 1) / rod.rate();
}

// EI shifts the modes of a chain by its boundary layer at the clamp, relatively by
// Gamma^(-1/2)/2: 5e-4. At this length weight stretches it by Gamma r^2/(4 L^2) = 4e-4.
constexpr double chain_gamma = 1e6, chain_length = 1;

double chain_mode(double mode) {
  constexpr double zeros[] = {2.404825557695773, 5.520078110286311, 8.653727912911012};
  return zeros[static_cast<std::size_t>(mode) - 1] / 2;  // of J_0
}

double measure_chain(const ModelTrial& trial) {
  const TestRod rod{.length = chain_length};
  const double g = rod.gravity(chain_gamma);
  Statics statics(trial.variant, rod.strand(trial.elements, hanging_clamp()), {0, 0, -g});
  statics.relax(1);
  return bending_mode(statics, static_cast<int>(trial.parameter)) /
         std::sqrt(g / rod.length);
}

/// The first motion in the plane of the arc, x and z.
double measure_curved_beam(const ModelTrial& trial) {
  TestRod rod;
  rod.natural = uniform_shape({0, trial.parameter / rod.length, 0});
  Statics statics(trial.variant, rod.strand(trial.elements, horizontal_clamp()), {});
  statics.relax(1);
  for (const SmallMotion& motion : statics.motions()) {
    double in_plane = 0, across = 0;
    const std::vector<double> u = statics.displacements(motion);
    for (std::size_t k = 0; k < u.size(); k += 3) {
      in_plane += u[k] * u[k] + u[k + 2] * u[k + 2];
      across += u[k + 1] * u[k + 1];
    }
    if (in_plane > across) return std::sqrt(motion.square) / rod.rate();
  }
  throw std::runtime_error("no motion in the plane");
}

}  // namespace

/// Frequencies of small free vibrations about an equilibrium.
std::vector<ValidationTest> vibration_tests() {
  const std::vector<std::string_view> rods{"super_helix", "super_clothoid", "der",
                                           "corde", "dynamic_spline"};
  return {
      {
          .name = "beam_modes",
          .what = "bending vibrations of a clamped strand without weight",
          .source = "Rayleigh 1877; the beam equation by shooting",
          .parameter = "number of the mode",
          .quantity = "omega sqrt(rho S L^4/EI)",
          .range = {1, 5, true},
          .quick = {{1, 2, 3}, {10, 40}},
          .usual = {{1, 2, 3}, {5, 10, 20, 40}},
          .full = {{1, 2, 3, 4, 5}, {5, 10, 20, 40, 80}},
          .tolerance = 0.01,
          .why = one_per_cent,
          .judged_from = 40,
          .claimed = rods,
          .reference =
              [](double mode) {
                const auto number = static_cast<int>(mode);
                return heavy_rod_mode(0.0, number);
              },
          .measure = measure_beam,
      },
      {
          .name = "heavy_rod",
          .what = "first vibration of a hanging (Gamma > 0) or standing strand",
          .source = "Schafer 1985; its equation by compound matrices",
          .parameter = "Gamma = rho g S L^3/EI",
          .quantity = "omega sqrt(rho S L^4/EI)",
          .range = {-7.8, 1e5},
          .quick = {{-7, 10, 1000}, {10, 40}},
          .usual = {{-7, -4, 1, 10, 100, 1000, 10000}, {5, 10, 20, 40}},
          .full = {{-7, -4, -1, 1, 3, 10, 30, 100, 300, 1000, 3000, 10000},
                   {5, 10, 20, 40, 80}},
          .tolerance = 0.01,
          .why = one_per_cent,
          .judged_from = 40,
          .claimed = rods,
          .reference = [](double gamma) { return heavy_rod_mode(gamma, 1); },
          .measure = measure_heavy_rod,
      },
      {
          .name = "heavy_chain",
          .what = "vibrations of a hanging strand of negligible stiffness, Gamma = 1e6",
          .source = "D. Bernoulli 1738; zeros of the Bessel function J_0",
          .parameter = "number of the mode, 1 to 3",
          .quantity = "omega sqrt(L/g)",
          .range = {1, 3, true},
          .quick = {{1, 2, 3}, {40}},
          .usual = {{1, 2, 3}, {5, 10, 20, 40}},
          .full = {{1, 2, 3}, {5, 10, 20, 40, 80}},
          .tolerance = 0.01,
          .why = one_per_cent,
          .judged_from = 40,
          .claimed = rods,
          .reference = chain_mode,
          .measure = measure_chain,
      },
      {
          .name = "curved_beam",
          .what = "first vibration in its plane of a strand that is naturally an arc",
          .source = "Den Hartog 1928; the inextensible arc's equations by shooting",
          .parameter = "angle of the arc (rad)",
          .quantity = "omega sqrt(rho S L^4/EI)",
          .range = {1e-2, 6},
          .quick = {{1.5707963267948966, 4.71238898038469}, {10, 40}},
          .usual = {{0.5, 1.5707963267948966, 3.141592653589793, 4.71238898038469},
                    {5, 10, 20, 40}},
          .full = {{0.5, 1, 1.5707963267948966, 2, 3.141592653589793, 4.71238898038469},
                   {5, 10, 20, 40, 80}},
          .tolerance = 0.01,
          .why = one_per_cent,
          .judged_from = 40,
          .claimed = rods,
          .reference = [](double opening) { return curved_beam_mode(opening, 1); },
          .measure = measure_curved_beam,
      },
  };
}

}  // namespace tress::experiments::validation
