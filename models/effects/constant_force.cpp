#include "models/effects/constant_force.h"

#include "contract/input_error.h"

namespace tress::models {
namespace {

constexpr Parameter parameters_of_force[] = {{.name = "force_n_m",
                                              .help = "force per length x, y, z (N/m)",
                                              .min = -1e6,
                                              .max = 1e6,
                                              .components = 3,
                                              .fallback = "0,0,0"},
                                             {.name = "force_n_kg",
                                              .help = "force per mass x, y, z (N/kg)",
                                              .min = -1e6,
                                              .max = 1e6,
                                              .components = 3,
                                              .fallback = "0,0,0"}};

}  // namespace

std::span<const Parameter> constant_force_parameters() { return parameters_of_force; }

std::unique_ptr<const Effect> make_constant_force(const Parameters& parameters,
                                                  const RootMotion&) {
  return std::make_unique<ConstantForce>(parameters.vec("force_n_m"),
                                         parameters.vec("force_n_kg"));
}

ConstantForce::ConstantForce(Vec per_length, Vec per_mass)
    : per_length_(per_length), per_mass_(per_mass) {
  if (!is_finite(per_length) || !is_finite(per_mass)) {
    throw InputError("force is not finite", "effect constant_force",
                     "give three finite numbers in N/m and three in N/kg");
  }
}

void ConstantForce::add_load(double, const Points& p, InOut f) const noexcept {
  for (std::size_t i = 0; i < p.length.size(); ++i) {
    double* load = &f[3 * i];
    store3(load3(load) + force(p, i), load);
  }
}

std::optional<Vec> ConstantForce::uniform_acceleration() const noexcept {
  if (dot(per_length_, per_length_) > 0) return {};
  return per_mass_;
}

double ConstantForce::potential(double, const Points& p) const noexcept {
  double sum = 0;
  for (std::size_t i = 0; i < p.length.size(); ++i) {
    sum -= dot(force(p, i), load3(&p.x[3 * i]));
  }
  return sum;
}

}  // namespace tress::models
