#pragma once

#include <string>
#include <vector>

#include "simulation/scene/gradient_table.h"

namespace tress::simulation {

/// A direction of the unknowns, as parts of a unit vector.
struct CombinationPart {
  const SceneParameter* parameter;  // parameter of the unknown
  double part;                      // component of the unit vector
};
/// Direction of the unknowns, with a part for each.
using Combination = std::vector<CombinationPart>;

/// Returns in words what records do not determine: "the records do not determine
/// youngs_modulus_pa and density_kg_m3 together: points stay where they are if they
/// change in the same proportion". Parts below `least` are left out. Empty: no
/// combination.
std::string in_words(const std::vector<Combination>& combinations, double least);

}  // namespace tress::simulation
