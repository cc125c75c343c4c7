#pragma once

#include <algorithm>
#include <string_view>

#include "models/effects/catalogue.h"

namespace tress::models {

/// Numbers of an effect in which its load is affine in every state and at every time.
/// Lines with a choice need one of the words for it.
struct AffineNumbers {
  std::string_view effect, keys;  // keys are separated by '|'
  std::string_view choice = {};   // parameter that decides; empty: none
  std::string_view words = {};    // words of it for which the line holds
};

/// Gradients take central differences by all other numbers, and by those of plug-ins.
/// Damping of a body is not here: its force is rounded off where points leave.
inline constexpr AffineNumbers affine_numbers[] = {
    {"gravity", "gravity_m_s2"},
    {"linear_drag", "drag_kg_m_s|mass_damping_per_s"},
    {"constant_force", "force_n_m|force_n_kg"},
    {"quadratic_drag", "c_normal|c_tangential"},
    // They are in the Reynolds number.
    {"quadratic_drag", "air_density_kg_m3|strand_radius_m", "coefficients", "constant"},
    {"wind", "drag_kg_m_s|force_n_m|c_normal|c_tangential"},
    {"wind", "velocity_m_s|gust_speed_m_s", "law", "linear"},
    {"wind", "velocity_m_s", "profile", "constant|sine"},  // it carries gusts along
    {"wind", "air_density_kg_m3|strand_radius_m", "coefficients", "constant"},
    {"point_force", "force_n|follower_n"},
    {"distributed_load", "force_n_per_m|along_n_per_m|turned_n_per_m"},
    {"ring", "stiffness_n_per_m|damping_n_s_per_m"},
    {"tether", "stiffness_n_m|damping_n_s_m|pull_n"},
    {"body", "stiffness_n_m2|friction", "friction_law", "regularised"},
    {"self_contact", "stiffness_n_m2|viscosity_n_s_m2"},
};

/// Returns whether the load is affine in the number `key`: all lines that name it are
/// true.
inline bool affine_in(const EffectEntry& effect, std::string_view key,
                      const Parameters& values) {
  bool named = false;
  for (const AffineNumbers& one : affine_numbers) {
    if (one.effect != effect.id || std::ranges::count(words_of(one.keys), key) == 0) {
      continue;
    }
    named = true;
    if (one.choice.empty()) continue;
    if (std::ranges::count(words_of(one.words), values.word(one.choice)) == 0) {
      return false;
    }
  }
  return named;
}

}  // namespace tress::models
