#include "simulation/scene/material_table.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "contract/input_error.h"
#include "simulation/scene/shared_parameter.h"

namespace tress::simulation {
namespace {

// clang-format off
constexpr std::array keys{"radius_m", "ellipticity", "youngs_modulus_pa", "poisson_ratio", "density_kg_m3", "internal_friction_kg_m3_s", "curl_radius_m", "curl_pitch_m"};
// clang-format on
using Values = std::array<double, keys.size()>;
constexpr double must = std::numeric_limits<double>::quiet_NaN();  // be given

/// Radius (of the circle of the same area) and ellipticity: cross-sections of 5063, 4079
/// and 4210 um^2 and ratios of diameters of 1.29, 1.41 and 1.66 for Asian, Caucasian and
/// African American hair [TRI Princeton, Hair Ethnicity, table 3].
///
/// Young's modulus: 3.89 GPa, one value for all [Robbins, Chemical and Physical Behavior
/// of Human Hair, appendix]. The shear modulus there, 0.89 GPa, is not attainable by an
/// isotropic material; Poisson's ratio is the usual value of hair simulations, 0.48.
///
/// From memory, unverified: the density of dry hair, 1300 kg/m^3, and the curls, of the
/// size that [Bertails et al. 2006] give for African and wavy Caucasian hair.
///
/// Internal friction: 1e-10 kg m^3/s, fitted to an oscillating curly clump [Bertails et
/// al. 2006, in the course notes of 2008, figure 1.8]; a single hair may differ.
struct Named {
  std::string_view name;
  Values values;
};
constexpr Named materials[] = {
    {"hair.caucasian", {36.0e-6, 1.41, 3.89e9, 0.48, 1300, 1e-10, 0.01, 0.05}},
    {"hair.asian", {40.1e-6, 1.29, 3.89e9, 0.48, 1300, 1e-10, 0, 0}},
    {"hair.african", {36.6e-6, 1.66, 3.89e9, 0.48, 1300, 1e-10, 0.001, 0.01}},
    {"custom", {must, 1, must, must, must, 0, 0, 0}},
};

const Values& named(std::string_view name) {
  std::size_t i = 0;
  while (materials[i].name != name) ++i;
  return materials[i].values;
}

}  // namespace

std::span<const Parameter> material_table_parameters() {
  static const std::vector<Parameter> all = [] {
    std::vector<Parameter> list{
        {.name = "name",
         .help = "whose values hold where no key gives another; custom: give radius, "
                 "Young's modulus, Poisson's ratio and density",
         .choices = "hair.caucasian|hair.asian|hair.african|custom"}};
    for (const char* key :
         {"radius_m", "ellipticity", "youngs_modulus_pa", "poisson_ratio",
          "density_kg_m3", "internal_friction_kg_m3_s"}) {
      list.push_back(shared_parameter(key));
    }
    list.push_back({.name = "curl_radius_m",
                    .help = "shape = \"material\": radius of the helix at rest, 0: "
                            "straight (m)",
                    .min = 0,
                    .max = 1e3});
    list.push_back({.name = "curl_pitch_m",
                    .help = "the same: rise of the helix per turn (m)",
                    .min = -1e3,
                    .max = 1e3});
    for (std::size_t i = 0; i < keys.size(); ++i) {
      list[i + 1].number = materials[0].values[i];
    }
    return list;
  }();
  return all;
}

StrandMaterial strand_material(const Table& scene, const Table* own) {
  const bool renamed = own != nullptr && own->given("name");
  const Table& namer = renamed ? *own : scene;
  Values values = named(namer.values().word("name"));
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const std::string_view key = keys[i];
    if (!renamed && scene.given(key)) values[i] = scene.values().number(key);
    if (own != nullptr && own->given(key)) values[i] = own->values().number(key);
    if (std::isnan(values[i])) {
      throw InputError(fmt::format("a custom material needs {}", key),
                       namer.place("name"),
                       fmt::format("give {} in {}", key, namer.name()));
    }
  }
  const auto [radius, ellipticity, youngs, poisson, density, friction, curl, pitch] =
      values;
  if (poisson <= -1) {
    const Table& giver = own != nullptr && own->given("poisson_ratio") ? *own : scene;
    throw InputError("poisson_ratio = -1 has no shear modulus",
                     giver.place("poisson_ratio"), "give a number above -1, at most 0.5");
  }
  StrandMaterial all;
  all.material.density = density;
  all.material.youngs_modulus = youngs;
  all.material.shear_modulus = Material::shear_modulus_of(youngs, poisson);
  all.material.internal_friction = friction;
  const double stretch = std::sqrt(ellipticity);  // as models/strand/strand_parameters.h
  all.section = {radius * stretch, radius / stretch};
  all.curl_radius = curl;
  all.curl_pitch = pitch;
  return all;
}

}  // namespace tress::simulation
