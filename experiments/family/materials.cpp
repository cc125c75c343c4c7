// The family of rods of other materials than hair.
#include <cmath>
#include <iterator>
#include <numbers>

#include "contract/constants.h"
#include "experiments/family/populations.h"
#include "experiments/family/sampling.h"
#include "models/strand/material.h"

namespace tress::experiments::family {
namespace {

/// Sources of Young's modulus E; densities and losses of the same place. "Chosen": a
/// usual value, not measured. Ropes and the cable: E and density of a solid rod with
/// their bending stiffness and mass per length. Lengths, natural curvatures and Poisson's
/// ratios are chosen.
struct Material {
  std::string_view name;
  Range youngs_modulus;  // Pa, logarithmic
  double density;        // kg/m^3
  double radius;         // m
  Range length;          // m, logarithmic
  Range curvature;       // 1/m
  Range loss;            // factor, logarithmic
  double poisson_ratio;
};

/// Within a factor of 1.5 either way.
constexpr Range about(double x) { return {x / 1.5, 1.5 * x}; }

constexpr Material materials[] = {
    // Steel: NPTEL, Vibration and noise control, table 9.1.
    {"steel_wire_0.1mm",
     about(2.07e11),
     7850,
     5e-5,
     {0.1, 0.5},
     {0, 10},
     {1e-3, 1e-3},
     0.3},
    {"steel_wire_0.5mm",
     about(2.07e11),
     7850,
     2.5e-4,
     {0.3, 1},
     {0, 5},
     {1e-3, 1e-3},
     0.3},
    // Density of MoorPy; E and loss chosen.
    {"nylon_line", about(2.5e9), 1140, 1e-4, {0.1, 1}, {0, 30}, {0.05, 0.1}, 0.4},
    // The setup of [Miller et al. 2014]; numbers chosen.
    {"silicone_rod", about(1.3e6), 1200, 1.55e-3, {0.1, 0.4}, {0, 60}, {0.05, 0.1}, 0.5},
    // dismech-rods, example of active entanglement.
    {"silicone_tentacle", about(3e5), 1200, 5e-3, {0.1, 0.4}, {0, 20}, {0.1, 0.1}, 0.5},
    // Chosen: Ecoflex 00-30.
    {"soft_silicone", about(7e4), 1070, 5e-3, {0.05, 0.3}, {0, 0}, {0.1, 0.1}, 0.5},
    // E of 2.1 to 4 MPa: PMC11019708, table 2; the tube as a solid rod.
    {"silicone_tubing", about(3e6), 1150, 1.5e-3, {0.1, 1}, {0, 10}, {0.1, 0.1}, 0.5},
    // BeamAdapter of SOFA, 3instruments_collis.scn: stiff for a catheter.
    {"catheter_stiff", about(1e10), 1550, 1e-3, {0.3, 1.5}, {0, 0.5}, {0.05, 0.05}, 0.4},
    // Chosen.
    {"catheter_polyurethane",
     about(6e7),
     1100,
     1e-3,
     {0.3, 1.5},
     {0, 80},
     {0.1, 0.1},
     0.45},
    // From the softest to the stiffest in three-point bending [Harrison et al. 2011].
    {"guidewire",
     {9.5e9, 1.58e11},
     7200,
     4.45e-4,
     {0.3, 1.5},
     {0, 0.5},
     {0.01, 0.01},
     0.3},
    // E of a core of 0.15 mm: Adv. Mater. Process., October 2019, p. 49.
    {"nitinol_wire", about(4.8e10), 6450, 1.7e-4, {0.3, 1.5}, {0, 0}, {0.01, 0.01}, 0.33},
    // BeamAdapter of SOFA.
    {"platinum_coil",
     about(1.68e11),
     21000,
     1e-4,
     {0.1, 0.6},
     {286, 286},
     {1e-3, 1e-3},
     0.38},
    // E I 0.15 N m^2 of 114 loose wires (derived), 0.53 kg/m of MoorPy.
    {"wire_rope", about(3.06e8), 6750, 5e-3, {0.5, 10}, {0, 0}, {0.05, 0.2}, 0.3},
    // E I 3e-3 N m^2 (chosen), 0.059 kg/m of MoorPy.
    {"nylon_rope", about(6.1e6), 750, 5e-3, {0.3, 3}, {0, 0}, {0.1, 0.3}, 0.4},
    // E I 2e-3 N m^2, 0.04 kg/m (chosen).
    {"electric_cable", about(6.5e7), 2040, 2.5e-3, {0.3, 2}, {0, 5}, {0.2, 0.2}, 0.4},
};
static_assert(std::size(materials) == 15);

/// Returns the internal friction whose loss factor is `loss` at the lowest frequency of
/// the rod. The frequency is the root of the sum of squares of two. They are that of a
/// cantilever, 1.875^2 sqrt(EI/(rho A L^4)), and that of a hanging rigid rod, sqrt(3 g/(2
/// L)).
double friction_of(const Rod& rod, double loss) {
  const double bending = rod.bending_stiffness();
  const double cantilever =
      std::pow(1.875, 4) * bending / (rod.mass_per_length() * std::pow(rod.length, 4));
  const double omega = std::sqrt(cantilever + 1.5 * earth_gravity / rod.length);
  return loss / omega * bending;
}

}  // namespace

std::vector<Rod> draw_rods(int count, std::uint64_t seed) {
  constexpr std::uint64_t after_hair = 100;
  constexpr auto kinds = static_cast<double>(std::size(materials));
  Hypercube u(count, seed, after_hair);
  const auto kind = u.next(), long_ = u.next(), stiff = u.next(), curl = u.next(),
             loss = u.next();
  std::vector<Rod> all = draw_drives(Family::rods, u);
  for (std::size_t i = 0; i < all.size(); ++i) {
    Rod& rod = all[i];
    const Material& of = materials[static_cast<std::size_t>(kinds * kind[i])];
    rod.kind = of.name;
    rod.length = of.length.log_at(long_[i]);
    rod.radius = of.radius;
    rod.youngs_modulus = of.youngs_modulus.log_at(stiff[i]);
    rod.shear_modulus =
        models::Material::shear_modulus_of(rod.youngs_modulus, of.poisson_ratio);
    rod.density = of.density;
    rod.natural_curvature = of.curvature.at(curl[i]);
    rod.internal_friction = friction_of(rod, of.loss.log_at(loss[i]));
    rod.drag = air_drag(rod.radius, rod.air_speed());
  }
  return all;
}

}  // namespace tress::experiments::family
