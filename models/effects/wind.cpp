#include "models/effects/wind.h"

#include "contract/input_error.h"
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

namespace {

constexpr Parameter parameters_of_wind[] = {
    {.name = "velocity_m_s",
     .help = "velocity of the wind x, y, z; profile = sine: at its peak (m/s)",
     .min = -1e3,
     .max = 1e3,
     .components = 3,
     .fallback = "1,0,0"},
    {.name = "profile",
     .help = "the wind in time and space; sine: velocity sin(2 pi frequency t); gusts: "
             "velocity and a random part without divergence",
     .choices = "constant|sine|gusts"},
    {.name = "frequency_hz",
     .help = "profile = sine: frequency (1/s)",
     .number = 1,
     .min = 0,
     .max = 1e6},
    {.name = "gust_speed_m_s",
     .help = "profile = gusts: root mean square of the random part (m/s)",
     .number = 0.5,
     .min = 0,
     .max = 1e3},
    {.name = "gust_length_m",
     .help = "profile = gusts: typical wave length (m)",
     .number = 0.2,
     .min = 1e-6,
     .max = 1e6},
    {.name = "gust_time_s",
     .help = "profile = gusts: time in which a gust changes while the "
             "wind carries it (s)",
     .number = 0.5,
     .min = 1e-6,
     .max = 1e6},
    {.name = "seed",
     .help = "profile = gusts: random seed of the gusts",
     .number = 1,
     .min = 0,
     .max = 1e9,
     .whole = true},
    {.name = "law",
     .help = "force per length: nu (wind - v), quadratic drag at wind - v, or force_n_m "
             "where the wind is velocity_m_s and in proportion elsewhere",
     .choices = "linear|quadratic|force"},
    {.name = "drag_kg_m_s",
     .help = "law = linear: force per length and velocity (kg/(m s))",
     .number = 2e-5,
     .min = 0,
     .max = 1e6},
    {.name = "force_n_m",
     .help = "law = force: force per length (N/m)",
     .number = 1e-4,
     .min = 0,
     .max = 1e6},
    strand_radius_parameter,
    air_density_parameter,
    air_viscosity_parameter,
    coefficients_parameter,
    c_normal_parameter,
    c_tangential_parameter};

constexpr EffectUse uses_of_wind[] = {
    {"profile", "sine", "frequency_hz"},
    {"profile", "gusts", "gust_speed_m_s|gust_length_m|gust_time_s|seed"},
    {"law", "linear", "drag_kg_m_s"},
    {"law", "force", "force_n_m"},
    {"law", "quadratic",
     "strand_radius_m|air_density_kg_m3|air_viscosity_pa_s|coefficients|c_normal|"
     "c_tangential"},
    use_of_constant,
    use_of_reynolds};

template <class Law>
std::unique_ptr<const Effect> in_wind(const Law& law, const Parameters& parameters) {
  const auto blow = [&law]<class Wind>(Wind wind) -> std::unique_ptr<const Effect> {
    return std::make_unique<AirDrag<Law, Wind>>("wind", law, std::move(wind));
  };
  const Vec velocity = parameters.vec("velocity_m_s");
  const std::string_view profile = parameters.word("profile");
  if (profile == "sine") {
    return blow(SineWind{velocity, parameters.number("frequency_hz")});
  }
  if (profile == "gusts") {
    return blow(Gusts(velocity, parameters.number("gust_speed_m_s"),
                      parameters.number("gust_length_m"),
                      parameters.number("gust_time_s"),
                      static_cast<std::uint64_t>(parameters.whole("seed"))));
  }
  return blow(SteadyWind{velocity});
}

/// The law for law = force, as a force per length and velocity.
StandingAirLaw standing_law(const Parameters& parameters) {
  const Vec velocity = parameters.vec("velocity_m_s");
  const double speed = norm(velocity);
  if (!(speed > 0)) {
    throw InputError("velocity_m_s is 0", "effect wind, law = force",
                     "give the direction of the force as a velocity that is not 0");
  }
  return {{parameters.number("force_n_m") / speed}};
}

}  // namespace

std::span<const Parameter> wind_parameters() { return parameters_of_wind; }
std::span<const EffectUse> quadratic_drag_uses() {
  static constexpr EffectUse all[] = {use_of_constant, use_of_reynolds};
  return all;
}
std::span<const EffectUse> wind_uses() { return uses_of_wind; }

std::unique_ptr<const Effect> make_wind(const Parameters& parameters, const RootMotion&) {
  const std::string_view law = parameters.word("law");
  if (law == "force") return in_wind(standing_law(parameters), parameters);
  if (law == "quadratic") {
    return with_anisotropic_law(
        parameters, [&](const auto& drag) { return in_wind(drag, parameters); });
  }
  return in_wind(LinearAirLaw{parameters.number("drag_kg_m_s")}, parameters);
}

}  // namespace tress::models
