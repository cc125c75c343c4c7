#pragma once

#include <cstdint>

#include "simulation/groom/cap.h"
#include "simulation/scene/strand_table.h"

namespace tress::simulation {

/// [groom]: many strands from a few numbers, their roots on an ellipsoid with axes along
/// x, y and z.
std::span<const Parameter> groom_table_parameters();
/// Keys by which each strand gets the number of elements that it needs
/// (needed_elements.h).
std::span<const Parameter> detail_parameters();
/// Largest distance by which a strand's shape may be off, m; 0: the groom does not say.
/// Throws InputError where the keys contradict each other.
double detail_tolerance(const Table& groom);

/// Roots at equal shares of the area of the cap. Fibonacci's lattice (i + 1/2)/n, frac(i
/// golden) is mapped to the ellipsoid by its area, tabulated in 256 x 256 cells. A root's
/// tangent lies between the ellipsoid's normal and the combing direction: down along the
/// surface, and away from the parting.
class Groom {
 public:
  /// All are referred to. Throws InputError with the location of an invalid key, and on
  /// more than `most` strands.
  Groom(const Table& table, const Table* own_material, const Common& common,
        std::size_t most);

  /// Returns the number of strands.
  std::size_t count() const { return count_; }
  /// Strand i < count() draws its length, curl and phase from this stream of the seed.
  /// Safe for several threads. Throws InputError if an element winds too far.
  Strand strand(std::size_t i, std::uint64_t stream) const;

 private:
  int elements(double length, const Shape& natural, const Frame& root) const;

  const Table& table_;
  const Common& common_;
  StrandMaterial material_;
  Cap cap_;
  std::size_t count_;
  double tolerance_;  // m, 0: none
};

}  // namespace tress::simulation
