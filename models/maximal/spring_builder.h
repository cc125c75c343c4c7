#pragma once

#include "models/maximal/nodal_strand.h"
#include "models/maximal/spring_elasticity.h"

namespace tress::models {

/// Bending springs of a joint: `angular` or `second_neighbour` (mass_spring.cpp), or
/// `angle` (lifted_curls.cpp).
enum class Bending { angular, second_neighbour, angle };

/// The springs of one strand at its rest shape, with the stiffness of its sections.
class SpringBuilder {
 public:
  /// Begins without springs.
  SpringBuilder(const Strand& strand, const NodalStrand& nodal);

  /// Adds springs along edges.
  void add_stretch();
  void add_bending(Bending bending);  // with a clamp's wall
  /// Adds springs of altitudes, against torsion.
  void add_altitudes();
  /// Adds springs of dihedral angles, against torsion.
  void add_dihedrals();

  Springs springs;  // springs so far

 private:
  template <class Strain>
  void add(Spring<Strain> spring);
  void add_wall();
  double floor_at(std::size_t edge) const;
  template <class Strain>
  void add_altitude(const Strain& strain, std::size_t first, std::size_t middle);

  const Strand& strand_;
  bool clamped_;
  Frame clamp_;
  std::vector<Vec> rest_;  // edges
};

}  // namespace tress::models
