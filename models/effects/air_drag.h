#pragma once

#include <memory>
#include <utility>

#include "contract/parameters.h"
#include "models/effects/air_law.h"
#include "models/effects/catalogue.h"
#include "models/effects/effect.h"
#include "models/motion/wind_field.h"

namespace tress::models {

/// Force of moving air on a strand, with air velocity w(t, x), for any law of air_law.h
/// and any field of wind_field.h. The force is f = law(v - w), with df/dv = law' and
/// df/dx = -law' dw/dx. All its work counts as power; there is no potential. Law and
/// field are types, so still air costs nothing. O(points).
template <class Law, class Wind>
class AirDrag final : public Effect {
  static constexpr bool uniform = Wind::Flow::uniform;

 public:
  /// Combines a law with a field under a name of the catalogue.
  AirDrag(std::string_view name, Law law, Wind wind)
      : name_(name), law_(law), wind_(std::move(wind)) {}

  std::string_view name() const override { return name_; }
  Needs needs() const override {
    return {.position = !uniform,
            .velocity = true,
            .tangent = Law::tangent,
            .derivatives = Law::relative || !uniform,
            .directions = Law::tangent};
  }
  void add_load(double t, const Points& p, InOut f) const noexcept override {
    const auto flow = wind_.at(t);
    for (std::size_t i = 0; i < p.length.size(); ++i) {
      double* load = &f[3 * i];
      store3(load3(load) + law_.force(p, i, velocity(flow, p, i)), load);
    }
  }
  void add_derivatives(double t, const Points& p, double pos, double vel,
                       InOut blocks) const noexcept override {
    if constexpr (Law::relative || !uniform) {
      const auto flow = wind_.at(t);
      for (std::size_t i = 0; i < p.length.size(); ++i) {
        const Mat3 slope = law_.slope(p, i, velocity(flow, p, i));
        if constexpr (Law::relative) add9(vel * slope, &blocks[9 * i]);
        if constexpr (!uniform) {
          add9(-pos * (slope * flow.gradient(load3(&p.x[3 * i]))), &blocks[9 * i]);
        }
      }
    }
  }
  void add_direction_derivatives(double t, const Points& p, double factor,
                                 InOut blocks) const noexcept override {
    if constexpr (Law::tangent) {
      const auto flow = wind_.at(t);
      for (std::size_t i = 0; i < p.length.size(); ++i) {
        add9(factor * law_.by_tangent(p, i, velocity(flow, p, i)), &blocks[9 * i]);
      }
    }
  }
  double potential(double, const Points&) const noexcept override { return 0; }
  double power(double t, const Points& p) const noexcept override {
    const auto flow = wind_.at(t);
    double sum = 0;
    for (std::size_t i = 0; i < p.length.size(); ++i) {
      sum += dot(law_.force(p, i, velocity(flow, p, i)), load3(&p.v[3 * i]));
    }
    return sum;
  }

 private:
  template <class Flow>
  static Vec velocity(const Flow& flow, const Points& p, std::size_t i) {
    const Vec x = uniform ? Vec{} : load3(&p.x[3 * i]);
    const Vec v = Law::relative ? load3(&p.v[3 * i]) : Vec{};
    return v - flow.velocity(x);
  }

  std::string_view name_;
  Law law_;
  Wind wind_;
};

/// Parameters of AnisotropicAirLaw, for effects that offer it.
inline constexpr Parameter air_density_parameter{.name = "air_density_kg_m3",
                                                 .help = "density of the air (kg/m^3)",
                                                 .number = 1.2,
                                                 .min = 0,
                                                 .max = 1e5};
/// Parameter for the viscosity of the air.
inline constexpr Parameter air_viscosity_parameter{
    .name = "air_viscosity_pa_s",
    .help = "coefficients = reynolds: dynamic viscosity of the air (Pa s)",
    .number = 1.8e-5,
    .min = 1e-9,
    .max = 1e3};
/// Parameter for the radius of the strand.
inline constexpr Parameter strand_radius_parameter{
    .name = "strand_radius_m",
    .help = "radius of the strand, not taken from [material] (m)",
    .number = 40e-6,
    .min = 0,
    .max = 1e3};
/// Parameter that selects the drag coefficient.
inline constexpr Parameter coefficients_parameter{
    .name = "coefficients",
    .help = "normal drag coefficient: c_normal, or of a cylinder at its Reynolds number",
    .choices = "constant|reynolds"};
/// Parameter for the drag coefficient across the strand.
inline constexpr Parameter c_normal_parameter{
    .name = "c_normal",
    .help = "coefficients = constant: drag coefficient across the strand",
    .number = 1.2,
    .min = 0,
    .max = 1e6};
/// Parameter for the friction coefficient along the strand.
inline constexpr Parameter c_tangential_parameter{
    .name = "c_tangential",
    .help = "friction coefficient along the strand, of its whole surface",
    .number = 0.01,
    .min = 0,
    .max = 1e6};

/// Parameter that applies to constant coefficients only.
inline constexpr EffectUse use_of_constant{"coefficients", "constant", "c_normal"};
/// Parameter that applies to coefficients by the Reynolds number only.
inline constexpr EffectUse use_of_reynolds{"coefficients", "reynolds",
                                           "air_viscosity_pa_s"};

/// Returns make(law) for the AnisotropicAirLaw that the parameters above describe.
template <class Make>
std::unique_ptr<const Effect> with_anisotropic_law(const Parameters& parameters,
                                                   const Make& make) {
  const double density = parameters.number("air_density_kg_m3");
  const double viscosity = parameters.number("air_viscosity_pa_s");
  const double radius = parameters.number("strand_radius_m");
  const double tangential =
      density * parameters.number("c_tangential") * std::numbers::pi * radius;
  if (parameters.word("coefficients") == "reynolds") {
    const CylinderDrag normal{viscosity / 2, 2 * radius * density / viscosity};
    return make(AnisotropicAirLaw<CylinderDrag>{normal, tangential});
  }
  const SquareDrag normal{density * parameters.number("c_normal") * radius};
  return make(AnisotropicAirLaw<SquareDrag>{normal, tangential});
}

}  // namespace tress::models
