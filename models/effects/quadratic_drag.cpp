#include "models/effects/quadratic_drag.h"

#include "models/effects/air_drag.h"

namespace tress::models {
namespace {

constexpr Parameter parameters_of_quadratic_drag[] = {
    strand_radius_parameter, air_density_parameter, air_viscosity_parameter,
    coefficients_parameter,  c_normal_parameter,    c_tangential_parameter};

}  // namespace

std::span<const Parameter> quadratic_drag_parameters() {
  return parameters_of_quadratic_drag;
}

std::unique_ptr<const Effect> make_quadratic_drag(const Parameters& parameters,
                                                  const RootMotion&) {
  return with_anisotropic_law(
      parameters, []<class Law>(const Law& law) -> std::unique_ptr<const Effect> {
        return std::make_unique<AirDrag<Law, StillAir>>("quadratic_drag", law,
                                                        StillAir{});
      });
}

}  // namespace tress::models
