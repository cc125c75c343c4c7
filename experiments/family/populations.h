#pragma once

#include <cstdint>
#include <vector>

#include "experiments/family/family.h"
#include "experiments/family/sampling.h"

namespace tress::experiments::family {

std::vector<Rod> draw_hair(int count, std::uint64_t seed);
std::vector<Rod> draw_rods(int count, std::uint64_t seed);

/// Rods with number and drive only, from the next three dimensions.
std::vector<Rod> draw_drives(Family family, Hypercube& u);

}  // namespace tress::experiments::family
