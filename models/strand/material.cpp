#include "models/strand/material.h"

#include <cmath>
#include <numbers>

#include "contract/input_error.h"

namespace tress::models {
namespace {

using std::numbers::pi;

void require_positive(double x, const std::string& what, const std::string& where) {
  if (std::isfinite(x) && x > 0) return;
  throw InputError(what + " is not a positive number", where, "give a number > 0");
}

}  // namespace

double CrossSection::area() const { return pi * a1 * a2; }
double CrossSection::inertia1() const { return area() * a2 * a2 / 4; }
double CrossSection::inertia2() const { return area() * a1 * a1 / 4; }
double CrossSection::torsion() const {
  return area() * (a1 * a1) * (a2 * a2) / (a1 * a1 + a2 * a2);
}
double CrossSection::polar() const { return inertia1() + inertia2(); }

Vec stiffness(const Material& material, const CrossSection& section) {
  return {material.shear_modulus * section.torsion(),
          material.youngs_modulus * section.inertia1(),
          material.youngs_modulus * section.inertia2()};
}

void check(const Material& material, const std::string& where) {
  require_positive(material.density, "density", where);
  require_positive(material.youngs_modulus, "Young's modulus", where);
  require_positive(material.shear_modulus, "shear modulus", where);
  if (!std::isfinite(material.internal_friction) || material.internal_friction < 0) {
    throw InputError("internal friction is negative or not finite", where,
                     "give a number >= 0 in kg m^3/s");
  }
}

void check(const CrossSection& section, const std::string& where) {
  require_positive(section.a1, "half-axis a1 of the section", where);
  require_positive(section.a2, "half-axis a2 of the section", where);
}

}  // namespace tress::models
