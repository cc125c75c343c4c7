#include "models/contact/contact_law.h"

#include <algorithm>
#include <cmath>

#include "contract/input_error.h"

namespace tress::models {
namespace {

constexpr Parameter parameters_of_contact[] = {
    {.name = "stiffness_n_m2",
     .help = "repulsion per length and depth, K (N/m^2)",
     .number = 2e-4,
     .min = 0,
     .max = 1e12},
    {.name = "viscosity_n_s_m2",
     .help = "force per length against the relative velocity, D (N s/m^2)",
     .number = 2e-3,
     .min = 0,
     .max = 1e12},
    {.name = "inner_radius_m",
     .help = "strands nearer than this repel each other, P (m)",
     .number = 3e-3,
     .min = 1e-9,
     .max = 1e3},
    {.name = "outer_radius_m",
     .help = "strands farther apart feel no viscous force, more than inner_radius_m (m)",
     .number = 6e-3,
     .min = 1e-9,
     .max = 1e3},
};

}  // namespace

std::span<const Parameter> contact_parameters() { return parameters_of_contact; }

ContactLaw::ContactLaw(const Parameters& parameters, const std::string& where)
    : ContactLaw({.stiffness = parameters.number("stiffness_n_m2"),
                  .viscosity = parameters.number("viscosity_n_s_m2"),
                  .inner = parameters.number("inner_radius_m"),
                  .outer = parameters.number("outer_radius_m")},
                 where) {}

ContactLaw::ContactLaw(const Values& values, const std::string& where) : law_(values) {
  const bool numbers = std::isfinite(values.stiffness) && values.stiffness >= 0 &&
                       std::isfinite(values.viscosity) && values.viscosity >= 0 &&
                       values.inner > 0 && std::isfinite(values.outer);
  if (!numbers) {
    throw InputError("a number of the contact law is not finite or negative", where,
                     "give stiffness and viscosity >= 0 and an inner radius > 0");
  }
  if (!(values.outer > values.inner)) {
    throw InputError("outer_radius_m is not larger than inner_radius_m", where,
                     "give a larger outer radius, such as twice the inner one");
  }
}

double ContactLaw::rho(const Vec& d) const noexcept {
  const double off = rounded_off * law_.inner;
  return std::sqrt(dot(d, d) + off * off);
}

Vec ContactLaw::force(const Vec& d, const Vec& u) const noexcept {
  const Factors<double> at = factors(d);
  return at.push * d - at.drag * u;
}

ContactLaw::Slopes ContactLaw::slopes(const Vec& d, const Vec& u) const noexcept {
  const Factors<double> at = factors(d);
  const Vec column = at.push_slope * d - at.drag_slope * u;
  return {{at.push + column.x * d.x, column.x * d.y, column.x * d.z,  //
           column.y * d.x, at.push + column.y * d.y, column.y * d.z,  //
           column.z * d.x, column.z * d.y, at.push + column.z * d.z},
          -at.drag};
}

double ContactLaw::potential(const Vec& d) const noexcept {
  const double depth = std::max(0.0, law_.inner - rho(d));
  return law_.stiffness / 2 * depth * depth;
}

}  // namespace tress::models
