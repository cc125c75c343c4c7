#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "simulation/scene/scene.h"

/// Single clamped hairs, drawn at random (uniform length 5 to 30 cm, radius 30 to 60 um,
/// logarithmic modulus 1 to 5 GPa; straight, wavy or curled; released, shaken or turned;
/// with and without friction and drag), for tests of what runs promise of their errors.
namespace tress::testing_support {

struct ControlledHair {
  std::string name;
  double length;  // m
  std::string radius, modulus, ellipticity, friction, shape, drive, drag;
  int elements;
};

inline const std::vector<ControlledHair>& controlled_hairs() {
  const auto wavy = [](const std::string& wave, const std::string& length) {
    return "shape = \"wavy\"\nwave_per_m = " + wave + "\nwavelength_m = " + length + "\n";
  };
  const auto curled = [](const std::string& radius, const std::string& pitch) {
    return "shape = \"helix\"\ncurl_radius_m = " + radius + "\ncurl_pitch_m = " + pitch +
           "\n";
  };
  const auto turned = [](const std::string& frequency) {
    return "[root]\nmotion = \"rotate\"\nangle_rad = 0.5\nfrequency_hz = " + frequency +
           "\n";
  };
  const auto shaken = [](const std::string& frequency) {
    return "[root]\nmotion = \"shake\"\namplitude_m = 0.02\nfrequency_hz = " + frequency +
           "\n";
  };
  static const std::vector<ControlledHair> all{
      {"StraightTurned", .249, "3.18e-5", "3.59e9", "1.55", "1e-10", "", turned("2.14"),
       "0", 6},
      {"StraightStiff", .18, "4.26e-5", "1.45e9", "1.09", "1e-12", "", turned("1.48"),
       "0", 6},
      {"WavyTurned", .174, "4.08e-5", "3.37e9", "1.28", "1e-10", wavy("88.9", "0.0226"),
       turned("2.79"), "1e-5", 10},
      {"CurledDamped", .155, "5.93e-5", "2.8e9", "1.54", "1e-10",
       curled("0.00539", "0.0224"), "", "1e-5", 8},
      {"CurledShaken", .171, "5.71e-5", "2.47e9", "1.38", "1e-12",
       curled("0.00925", "0.0347"), shaken("1.41"), "1e-5", 6},
      {"CurledReleased", .137, "3.69e-5", "1.02e9", "1.54", "1e-12",
       curled("0.00984", "0.0454"), "", "0", 12}};
  return all;
}

/// `integrator`: the lines of its table.
inline simulation::Scene scene_of(const ControlledHair& hair, std::string_view model,
                                  std::string_view integrator, std::string_view duration,
                                  int elements) {
  const std::string air =
      hair.drag == "0" ? "" : "[effects.linear_drag]\ndrag_kg_m_s = " + hair.drag + "\n";
  return simulation::parse_scene(
      "title = \"a hair\"\nframes_per_s = 60\nduration_s = " + std::string(duration) +
          "\n[model]\nid = \"" + std::string(model) + "\"\n[integrator]\n" +
          std::string(integrator) + "\n[material]\nname = \"custom\"\nradius_m = " +
          hair.radius + "\nellipticity = " + hair.ellipticity + "\nyoungs_modulus_pa = " +
          hair.modulus + "\npoisson_ratio = 0.3\ndensity_kg_m3 = 1300\n" +
          "internal_friction_kg_m3_s = " + hair.friction +
          "\n[strand]\nroot_tangent = [1, 0, 0]\nlength_m = " +
          std::to_string(hair.length) + "\nelements = " + std::to_string(elements) +
          "\n" + hair.shape + hair.drive + "[effects.gravity]\n" + air,
      "hair.toml");
}

}  // namespace tress::testing_support
