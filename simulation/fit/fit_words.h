#pragma once

#include <string>
#include <vector>

#include "simulation/scene/gradient_table.h"

namespace tress::simulation {

/// A direction of the unknowns, as parts of a unit vector.
struct CombinationPart {
  const SceneParameter* parameter;
  double part;
};
using Combination = std::vector<CombinationPart>;

/// Returns in words what records do not determine: "the records do not determine
/// youngs_modulus_pa and density_kg_m3 together: points stay where they are if they
/// change in the same proportion". Parts below `least` are left out. Empty: no
/// combination.
std::string in_words(const std::vector<Combination>& combinations, double least);

}  // namespace tress::simulation
