#pragma once

#include <memory>

#include "experiments/harness/model_variants.h"
#include "models/effects/effect.h"
#include "models/strand/strand.h"

namespace tress {

/// The hair that tests are made of, in SI units: radius 40 um, E = 3 GPa, density 1300
/// kg/m^3, 10 cm long, so EI = 6.03e-9 N m^2, EA L^2/EI = 2.5e7. What a test measures has
/// no dimension, so that only ratios matter: Gamma = rho g S L^3/EI is set by gravity.
struct TestRod {
  static constexpr double length = 0.1, radius = 40e-6;  // m
  static constexpr double youngs_modulus = 3e9;          // Pa
  static constexpr double density = 1300;                // kg/m^3

  double poisson_ratio = 0.5;
  Vec natural{},
      initial{};  // twist and curvatures, 1/m; initial also where it is natural

  static double bending();              // EI, N m^2
  double twisting() const;              // GJ
  static double line_mass();            // rho S, kg/m
  static double rate();                 // sqrt(EI/(rho S L^4)), 1/s
  static double force();                // EI/L^2, N
  static double gravity(double gamma);  // g (m/s^2) of that Gamma

  /// Clamped at the origin with its tangent along `frame.e0`.
  Strand strand(int elements, const Frame& frame) const;
};

/// Clamps: horizontal (e0 = x, e1 = y, curvature about e1 bends down), hanging and
/// standing, as the words of root_tangent in models/strand/strand_parameters.h.
Frame horizontal_clamp();
Frame hanging_clamp();
Frame standing_clamp();

/// The variant's model of that strand. Throws InputError where the model refuses it.
std::unique_ptr<System> on_strand(const ModelVariant& variant, const Strand& strand,
                                  Effects effects);

}  // namespace tress
