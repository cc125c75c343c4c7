#include "models/effects/linear_drag.h"

#include <cmath>

#include "contract/input_error.h"
#include "math/vec3.h"

namespace tress::models {
namespace {

constexpr Parameter parameters_of_drag[] = {
    {.name = "drag_kg_m_s",
     .help = "force per length and velocity, of a hair in air 1e-6 to 1e-4 (kg/(m s))",
     .number = 2e-5,
     .min = 0,
     .max = 1e6},
    {.name = "mass_damping_per_s",
     .help = "force per mass and velocity (1/s)",
     .number = 0,
     .min = 0,
     .max = 1e6}};

bool finite_and_not_negative(double x) { return std::isfinite(x) && x >= 0; }

}  // namespace

std::span<const Parameter> linear_drag_parameters() { return parameters_of_drag; }

std::unique_ptr<const Effect> make_linear_drag(const Parameters& parameters,
                                               const RootMotion&) {
  return std::make_unique<LinearDrag>(parameters.number("drag_kg_m_s"),
                                      parameters.number("mass_damping_per_s"));
}

LinearDrag::LinearDrag(double nu, double mass_damping)
    : nu_(nu), mass_damping_(mass_damping) {
  if (!finite_and_not_negative(nu) || !finite_and_not_negative(mass_damping)) {
    throw InputError("drag coefficient is negative or not finite", "effect linear_drag",
                     "give nu >= 0 in kg/(m s) and mass damping >= 0 in 1/s");
  }
}

void LinearDrag::add_load(double, const Points& p, InOut f) const noexcept {
  for (std::size_t i = 0; i < p.length.size(); ++i) {
    double* load = &f[3 * i];
    store3(load3(load) - rate(p, i) * load3(&p.v[3 * i]), load);
  }
}

void LinearDrag::add_derivatives(double, const Points& p, double, double vel,
                                 InOut blocks) const noexcept {
  for (std::size_t i = 0; i < p.length.size(); ++i) {
    const double slope = -vel * rate(p, i);
    double* block = &blocks[9 * i];
    block[0] += slope;
    block[4] += slope;
    block[8] += slope;
  }
}

double LinearDrag::power(double, const Points& p) const noexcept {
  double sum = 0;
  for (std::size_t i = 0; i < p.length.size(); ++i) {
    const Vec v = load3(&p.v[3 * i]);
    sum -= rate(p, i) * dot(v, v);
  }
  return sum;
}

}  // namespace tress::models
