#pragma once

#include <string>

#include "contract/layers.h"
#include "math/vec3.h"

namespace tress::models {

/// Linear elastic material with Kelvin-Voigt friction in bending and twisting.
struct Material {
  double density = 1300;         // kg/m^3
  double youngs_modulus = 3e9;   // Pa
  double shear_modulus = 1.0e9;  // Pa
  /// gamma: the moment gamma d(kappa)/dt opposes bending and twisting (kg m^3/s)
  /// [Bertails et al. 2006]; EI/gamma is a relaxation rate.
  double internal_friction = 0;

  /// G = E / (2 (1 + nu)).
  static double shear_modulus_of(double youngs_modulus, double poisson_ratio) {
    return youngs_modulus / (2 * (1 + poisson_ratio));
  }
};

/// Ellipse with half-axis a1 along the first and a2 along the second material axis of the
/// section (e1, e2 of the frame whose e0 is the tangent).
struct CrossSection {
  double a1 = 40e-6;  // m
  double a2 = 40e-6;  // m

  double area() const;      // pi a1 a2, m^2
  double inertia1() const;  // about e1: pi a1 a2^3/4, m^4
  double inertia2() const;  // about e2: pi a1^3 a2/4, m^4
  double torsion() const;   // J = pi a1^3 a2^3/(a1^2 + a2^2), m^4 (Saint-Venant)
  double polar() const;     // I1 + I2: rotational inertia about the tangent per density

  bool operator==(const CrossSection&) const = default;
};

/// GJ, EI1 and EI2: stiffness of twist and the two curvatures, N m^2.
Vec stiffness(const Material& material, const CrossSection& section);

/// Throw InputError naming `where` unless density, moduli and half-axes are positive,
/// friction >= 0 and all numbers finite.
void check(const Material& material, const std::string& where);
/// Throws InputError naming `where` unless both half-axes are positive and finite.
void check(const CrossSection& section, const std::string& where);

}  // namespace tress::models
