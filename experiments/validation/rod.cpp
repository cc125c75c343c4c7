#include "experiments/validation/rod.h"

#include <cmath>

namespace tress {
namespace {

constexpr CrossSection section{TestRod::radius, TestRod::radius};

}  // namespace

double TestRod::bending() { return youngs_modulus * section.inertia1(); }

double TestRod::twisting() const {
  return Material::shear_modulus_of(youngs_modulus, poisson_ratio) * section.torsion();
}

double TestRod::line_mass() { return density * section.area(); }

double TestRod::rate() { return std::sqrt(bending() / line_mass()) / (length * length); }

double TestRod::force() { return bending() / (length * length); }

double TestRod::gravity(double gamma) {
  return gamma * bending() / (line_mass() * length * length * length);
}

Strand TestRod::strand(int elements, const Frame& frame) const {
  Material material;
  material.density = density;
  material.youngs_modulus = youngs_modulus;
  material.shear_modulus = Material::shear_modulus_of(youngs_modulus, poisson_ratio);
  Strand strand = make_strand(material, section, {.elements = elements, .length = length},
                              uniform_shape(natural), uniform_shape(initial));
  strand.root.frame = frame;
  return strand;
}

Frame horizontal_clamp() { return {}; }
Frame hanging_clamp() { return {{0, 0, -1}, {0, 1, 0}, {1, 0, 0}}; }
Frame standing_clamp() { return {{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}}; }

std::unique_ptr<System> on_strand(const ModelVariant& variant, const Strand& strand,
                                  Effects effects) {
  Parameters parameters(variant.model->parameters,
                        "model " + std::string(variant.model->id));
  for (const auto& [key, value] : variant.settings) parameters.set(key, value);
  return variant.model->on_strand(strand, parameters, std::move(effects));
}

}  // namespace tress
