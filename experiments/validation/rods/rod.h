#pragma once

#include <memory>

#include "experiments/problems/strand_models.h"
#include "experiments/validation/rods/end.h"
#include "models/effects/effect.h"
#include "models/strand/strand.h"

namespace tress::experiments::validation {

/// The hair of the tests, in SI units: radius 40 um, E = 3 GPa, density 1300 kg/m^3, 10
/// cm long, so EI = 6.03e-9 N m^2, EA L^2/EI = 2.5e7. Measured quantities are
/// dimensionless, so that only ratios matter: Gamma = rho g S L^3/EI is set by gravity.
struct TestRod {
  double length = 0.1;                   // L, m
  double poisson_ratio = 0.5;            // GJ/EI = 1/(1 + nu)
  Shape natural = uniform_shape(Vec{});  // over s in [0, L], 1/m
  Shape initial = {};                    // initial shape of statics; empty: natural
  double grading = 1;                    // length ratio of the last element to the first

  double bending() const;              // EI, N m^2
  double twisting() const;             // GJ
  double line_mass() const;            // rho S, kg/m
  double rate() const;                 // sqrt(EI/(rho S L^4)), 1/s
  double force() const;                // EI/L^2, N
  double gravity(double gamma) const;  // g (m/s^2) for that Gamma

  /// Clamped at the origin with its tangent along `clamp.e0`.
  Strand strand(int elements, const Frame& clamp) const;
};

/// Clamps: horizontal (e0 = x, e1 = y, curvature about e1 bends down), hanging and
/// standing, as root_tangent in models/strand/strand_parameters.h.
Frame horizontal_clamp();
Frame hanging_clamp();
Frame standing_clamp();

/// The variant's model of that strand. Throws InputError if the model refuses it.
std::unique_ptr<System> on_strand(const ModelVariant& variant, const Strand& strand,
                                  Effects effects);

/// Returns an end whose section is held to `frame`. For models whose end section is fixed
/// to their last edge or link, it includes the half segment beyond the last joint. The
/// support must have its compliance, or half an edge of the rod would be missing. Models
/// that bend up to their tip have no such half segment.
End held_section(const ModelVariant& variant, const Strand& strand, End::Section section,
                 const Frame& frame);

/// Returns the reason why a test that holds the tip section does not apply to a model;
/// empty: it applies.
std::string no_section(const ModelVariant& variant);

/// Returns the reason why a test with a non-planar natural curvature does not apply to
/// a model; empty: it applies.
std::string no_curl(const ModelVariant& variant);

}  // namespace tress::experiments::validation
