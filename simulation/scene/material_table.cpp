#include "simulation/scene/material_table.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "contract/input_error.h"
#include "simulation/scene/shared_parameter.h"

namespace tress::simulation {
namespace {

// clang-format off
constexpr std::array keys{"radius_m", "ellipticity", "youngs_modulus_pa", "density_kg_m3", "internal_friction_kg_m3_s", "curl_radius_m", "curl_pitch_m"};
// clang-format on
using Values = std::array<double, keys.size()>;
constexpr double must = std::numeric_limits<double>::quiet_NaN();  // be given

/// E/G of hair, which is not isotropic: 3.89 and 0.89 GPa [Robbins 1994, appendix, as
/// quoted on Biomch-L in 1998]. An isotropic material has at most 3.
constexpr double anisotropy = 3.89 / 0.89;

/// Radius (of the circle of the same area) and ellipticity follow from measured sections.
/// For Asian, Caucasian and African American hair these are 5063, 4079 and 4210 um^2,
/// with ratios of diameters of 1.29, 1.41 and 1.66 [TRI Princeton, Hair Ethnicity, table
/// 3].
///
/// Young's modulus: 3.8 GPa, one value for all, of dry hair at a humidity of 50 % [TRI
/// Princeton, appendix B]. Wet hair has a half to a third of that modulus [J. Cosmet.
/// Sci. 72 (2021), p. 673].
///
/// From memory, unverified: the density of dry hair, 1320 kg/m^3, and the curls, of the
/// size that [Bertails et al. 2006] give for African and wavy Caucasian hair.
///
/// Internal friction: 1e-10 kg m^3/s, fitted to an oscillating curly clump [Bertails et
/// al. 2006, in the course notes of 2008, figure 1.8]. The damping time, friction over E
/// I, is then 13 to 20 ms. That of a lone hair is not known; the family of the
/// experiments draws 0.3 to 10 ms.
struct Named {
  std::string_view name;
  Values values;
  double youngs_over_shear;  // E/G
};
constexpr Named materials[] = {
    {"hair.caucasian", {36.0e-6, 1.41, 3.8e9, 1320, 1e-10, 0.01, 0.05}, anisotropy},
    {"hair.asian", {40.1e-6, 1.29, 3.8e9, 1320, 1e-10, 0, 0}, anisotropy},
    {"hair.african", {36.6e-6, 1.66, 3.8e9, 1320, 1e-10, 0.001, 0.01}, anisotropy},
    {"custom", {must, 1, must, must, 0, 0, 0}, must},
};

const Named& named(std::string_view name) {
  std::size_t i = 0;
  while (materials[i].name != name) ++i;
  return materials[i];
}

/// The shear modulus G of a strand: a number, or E over a number.
struct Shear {
  double youngs_over_shear;
  std::optional<double> modulus;

  double of(double youngs) const { return modulus.value_or(youngs / youngs_over_shear); }

  /// What the table gives replaces what stood before.
  void read(const Table& table) {
    refuse_both_moduli(table);
    if (table.given("shear_modulus_pa")) {
      modulus = table.values().number("shear_modulus_pa");
    }
    if (!table.given("poisson_ratio")) return;
    const double poisson = table.values().number("poisson_ratio");
    if (poisson <= -1) {
      throw InputError("poisson_ratio = -1 has no shear modulus",
                       table.place("poisson_ratio"),
                       "give a number above -1, at most 0.5");
    }
    youngs_over_shear = 2 * (1 + poisson);
    modulus.reset();
  }
};

}  // namespace

void refuse_both_moduli(const Table& table) {
  if (!table.given("shear_modulus_pa") || !table.given("poisson_ratio")) return;
  throw InputError("shear_modulus_pa and poisson_ratio are both given",
                   table.place("poisson_ratio"), "leave one of them out");
}

std::span<const Parameter> material_table_parameters() {
  static const std::vector<Parameter> all = [] {
    std::vector<Parameter> list{
        {.name = "name",
         .help = "material whose values apply where no key gives another; custom: give "
                 "radius, "
                 "Young's modulus, density, and shear modulus or Poisson's ratio",
         .choices = "hair.caucasian|hair.asian|hair.african|custom"}};
    for (const char* key : {"radius_m", "ellipticity", "youngs_modulus_pa",
                            "density_kg_m3", "internal_friction_kg_m3_s"}) {
      list.push_back(shared_parameter(key));
    }
    list.push_back({.name = "curl_radius_m",
                    .help = "shape = \"material\": radius of the helix at rest, 0: "
                            "straight (m)",
                    .min = 0,
                    .max = 1e3});
    list.push_back({.name = "curl_pitch_m",
                    .help = "shape = \"material\": rise of the helix per turn (m)",
                    .min = -1e3,
                    .max = 1e3});
    for (std::size_t i = 0; i < keys.size(); ++i) {
      list[i + 1].number = materials[0].values[i];
    }
    Parameter shear = shared_parameter("shear_modulus_pa");
    shear.help =
        "shear modulus G (Pa); where it is not given, G/E is that of the named material, "
        "whatever E is";
    shear.number = materials[0].values[2] / anisotropy;
    shear.min = shared_parameter("youngs_modulus_pa").min;
    Parameter poisson = shared_parameter("poisson_ratio");
    poisson.help =
        "Poisson's ratio nu of an isotropic material, above -1, in place of "
        "shear_modulus_pa: G = E/(2 (1 + nu)); without effect where it is not given";
    list.insert(list.begin() + 4, {shear, poisson});
    return list;
  }();
  return all;
}

StrandMaterial strand_material(const Table& scene, const Table* own) {
  const bool renamed = own != nullptr && own->given("name");
  const Table& namer = renamed ? *own : scene;
  const Named& made = named(namer.values().word("name"));
  Values values = made.values;
  Shear shear{made.youngs_over_shear, {}};
  for (const Table* giver : {renamed ? nullptr : &scene, own}) {
    if (giver == nullptr) continue;
    for (std::size_t i = 0; i < keys.size(); ++i) {
      if (giver->given(keys[i])) values[i] = giver->values().number(keys[i]);
    }
    shear.read(*giver);
  }
  const auto need = [&](double value, std::string_view key, std::string_view remedy) {
    if (!std::isnan(value)) return;
    throw InputError(fmt::format("a custom material needs {}", key), namer.place("name"),
                     fmt::format("give {} in {}", remedy, namer.name()));
  };
  for (std::size_t i = 0; i < keys.size(); ++i) need(values[i], keys[i], keys[i]);
  need(shear.of(1), "a shear modulus", "shear_modulus_pa or poisson_ratio");
  const auto [radius, ellipticity, youngs, density, friction, curl, pitch] = values;
  StrandMaterial all;
  all.material.density = density;
  all.material.youngs_modulus = youngs;
  all.material.shear_modulus = shear.of(youngs);
  all.material.internal_friction = friction;
  const double stretch = std::sqrt(ellipticity);  // as models/strand/strand_parameters.h
  all.section = {radius * stretch, radius / stretch};
  all.curl_radius = curl;
  all.curl_pitch = pitch;
  return all;
}

}  // namespace tress::simulation
