#include "models/effects/gravity.h"

#include <cmath>

#include "contract/input_error.h"

namespace tress::models {
namespace {

constexpr Parameter parameters_of_gravity[] = {{.name = "gravity_m_s2",
                                                .help = "acceleration x, y, z (m/s^2)",
                                                .min = -1e6,
                                                .max = 1e6,
                                                .components = 3,
                                                .fallback = "0,0,-9.81"}};

}  // namespace

std::span<const Parameter> gravity_parameters() { return parameters_of_gravity; }

std::unique_ptr<const Effect> make_gravity(const Parameters& parameters,
                                           const RootMotion&) {
  return std::make_unique<Gravity>(parameters.vec("gravity_m_s2"));
}

Gravity::Gravity(Vec acceleration) : g_(acceleration) {
  if (!std::isfinite(dot(g_, g_))) {
    throw InputError("gravity is not finite", "effect gravity",
                     "give three finite numbers in m/s^2");
  }
}

void Gravity::add_load(double, const Points& p, InOut f) const noexcept {
  for (std::size_t i = 0; i < p.mass.size(); ++i) {
    double* load = &f[3 * i];
    store3(load3(load) + p.mass[i] * g_, load);
  }
}

double Gravity::potential(double, const Points& p) const noexcept {
  double sum = 0;
  for (std::size_t i = 0; i < p.mass.size(); ++i) {
    sum -= p.mass[i] * dot(g_, load3(&p.x[3 * i]));
  }
  return sum;
}

}  // namespace tress::models
