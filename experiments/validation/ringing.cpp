// A straight, weightless hair that rings in one of its modes, observed in time.
//
// friction: released from the shape of its first bending mode. With Kelvin-Voigt
//   friction gamma in bending that mode decays by the rate (gamma/EI) omega^2/2, omega =
//   1.8751^2 sqrt(EI/(rho S L^4)): the basis of the calibration of gamma.
//
// torsion: released from the shape of a torsional mode: omega_n = (2 n - 1) pi/2
//   sqrt(G/rho)/L, a twist wave running to and fro. Observed in the kinetic energy,
//   which oscillates as sin^2(omega t): not every model reports the rotation of its tip.
#include <cmath>
#include <numbers>
#include <string>

#include "contract/forms/energetics.h"
#include "contract/input_error.h"
#include "experiments/validation/rods/motion.h"
#include "experiments/validation/rods/rod.h"
#include "experiments/validation/rods/signals.h"
#include "experiments/validation/test.h"
#include "simulation/run/simulation.h"

namespace tress::experiments::validation {
namespace {

using std::numbers::pi;

const double beam_length = TestRod().length;  // m
constexpr double bent = 0.05;  // rad, the largest curvature or twist times L

/// A straight hair with an initial shape out of equilibrium.
Strand hair(int elements, const Shape& initial) {
  TestRod rod;
  rod.initial = initial;
  return rod.strand(elements, horizontal_clamp());
}

constexpr double first_mode = 1.875104068711961;  // cos x cosh x = -1

double bending_rate() { return first_mode * first_mode * TestRod().rate(); }

/// Curvature of the first mode of a clamped rod, 1 at the clamp.
double mode_curvature(double s) {
  const double b = first_mode, x = b * s / beam_length;
  const double mixed = (std::cosh(b) + std::cos(b)) / (std::sinh(b) + std::sin(b));
  return (std::cosh(x) + std::cos(x) - mixed * (std::sinh(x) + std::sin(x))) / 2;
}

double decay(double damping_ratio) { return damping_ratio * bending_rate(); }

double measured_decay(const ModelTrial& trial) {
  Strand strand = hair(trial.elements, [](double s) {
    return Vec{0, bent / beam_length * mode_curvature(s), 0};
  });
  strand.material.internal_friction =
      2 * trial.parameter * TestRod().bending() / bending_rate();
  const auto system = on_strand(trial.variant, strand, {});
  const double once = 2 * pi / bending_rate();
  return decay_rate(
      track("implicit_midpoint", *system, once / 200, 5.3 * once, place(*system, -1, 2)));
}

double torsion_rate(double mode) {
  const Material material = hair(1, {}).material;
  const double speed = std::sqrt(material.shear_modulus / material.density);
  return (2 * mode - 1) * pi / 2 * speed / beam_length;
}

double measured_torsion(const ModelTrial& trial) {
  const double wave = (2 * trial.parameter - 1) * pi / (2 * beam_length);
  const auto system =
      on_strand(trial.variant,
                hair(trial.elements,
                     [wave](double s) {
                       return Vec{bent / beam_length * std::cos(wave * s), 0, 0};
                     }),
                {});
  const State start = initial_state(*system);
  const double energy = system->energetics()->energy(0, start.q, start.v).total();
  const double once = 2 * pi / torsion_rate(trial.parameter);
  const Look look = kinetic(*system);
  const Track swing =
      track("implicit_midpoint", *system, once / 200, 3.3 * once,
            [&](double t, In q, In v) { return look(t, q, v) - energy / 2; });
  return pi / period(swing);
}

}  // namespace

std::vector<ValidationTest> ringing_tests() {
  return {{
              .name = "friction",
              .what = "a hair that rings in its first mode dies out by internal friction",
              .source = "Kelvin-Voigt: (gamma/EI) omega^2/2; the calibration of gamma of "
                        "Bertails et al. 2006",
              .parameter = "damping ratio gamma omega/(2 EI)",
              .quantity = "rate of decay (1/s)",
              .range = {1e-4, 0.3},
              .quick = {{0.01}, {20}},
              .usual = {{0.003, 0.01, 0.03}, {5, 10, 20, 40}},
              .full = {{0.001, 0.003, 0.01, 0.03, 0.1}, {5, 10, 20, 40, 80}},
              .tolerance = 0.02,
              .why = "frequencies are asked for within 1 %, and the rate goes with their "
                     "square",
              .judged_from = 20,
              .claimed = {"super_helix", "super_clothoid", "articulated_chain", "der",
                          "corde", "xpbd_cosserat", "dynamic_spline", "kirchhoff_nodal"},
              .reference = decay,
              .measure = measured_decay,
          },
          {
              .name = "torsion",
              .what = "twist runs to and fro in a straight hair",
              .source = "(2 n - 1) pi/2 sqrt(G/rho)/L [Landau & Lifshitz, Theory of "
                        "Elasticity, section 25]",
              .parameter = "mode n",
              .quantity = "frequency (rad/s)",
              .range = {1, 5, true},
              .quick = {{1}, {20}},
              .usual = {{1, 2}, {5, 10, 20, 40}},
              .full = {{1, 2, 3}, {5, 10, 20, 40, 80}},
              .tolerance = 0.01,
              .why = "frequencies are asked for within 1 %",
              .judged_from = 20,
              .claimed = {"super_helix", "super_clothoid", "articulated_chain", "der",
                          "corde", "xpbd_cosserat", "dynamic_spline", "kirchhoff_nodal"},
              .reference = torsion_rate,
              .refusal = no_twist,
              .measure = measured_torsion,
          }};
}

}  // namespace tress::experiments::validation
