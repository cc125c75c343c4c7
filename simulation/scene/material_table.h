#pragma once

#include <span>
#include <string_view>

#include "contract/constants.h"
#include "models/strand/material.h"
#include "simulation/table/table.h"

namespace tress::simulation {

/// The contents of [material].
struct StrandMaterial {
  Material material;                       // density, moduli and friction
  CrossSection section;                    // shape and size of the section
  double curl_radius = 0, curl_pitch = 0;  // of the helix at rest, m; radius 0: straight

  /// Returns the weight per length at 9.81 m/s^2, N/m.
  double weight() const {  // N/m
    return earth_gravity * material.density * section.area();
  }
};

/// Returns the keys of [material].
std::span<const Parameter> material_table_parameters();

/// Throws InputError on a table that gives shear_modulus_pa and poisson_ratio.
void refuse_both_moduli(const Table& table);

/// The values of `scene`, overridden by those of `own` ([strand.material]), if any: a
/// name sets all of its values, other keys change single ones. Throws InputError naming
/// the key that a custom material lacks, and on two keys for one modulus.
StrandMaterial strand_material(const Table& scene, const Table* own);

}  // namespace tress::simulation
