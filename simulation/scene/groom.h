#pragma once

#include <vector>

#include "simulation/scene/strand_table.h"

namespace tress::simulation {

/// [groom]: many strands from a few numbers, their roots on an ellipsoid with axes along
/// x, y and z.
std::span<const Parameter> groom_table_parameters();

/// Roots at equal shares of the area of the cap: Fibonacci's lattice (i + 1/2)/n, frac(i
/// golden) mapped to the ellipsoid by its area, tabulated in 256 x 256 cells. Strand i
/// draws its length, curl and phase from stream `first_stream` + i of the seed. A root's
/// tangent lies between the ellipsoid's normal and the combing direction: down along the
/// surface, and away from the parting. Throws InputError with the location of an invalid
/// key, and on more than `most` strands.
std::vector<Strand> groom_strands(const Table& table, const Table* own_material,
                                  const Common& common, std::uint64_t first_stream,
                                  std::size_t most);

}  // namespace tress::simulation
