#pragma once

#include <map>

#include "simulation/scene/scene.h"

namespace tress::simulation {

/// Returns the largest angle by which an element of a strand winds, as the scene's model
/// takes it.
double largest_winding(const Scene& scene, const Strand& strand);
/// Returns the number of quadrature points of elements that wind by this angle; 0: the
/// scene gives the number, or its model has none.
int chosen_points(const Scene& scene, double winding);

/// The model's options of each strand. Strands with the same number of elements share
/// the number of quadrature points, the largest that one of them needs. A strand is then
/// the same in a batch and by itself. Throws InputError where an element winds too much.
class StrandOptions {
 public:
  /// Copies what it needs of the scene.
  explicit StrandOptions(const Scene& scene);

  /// Returns the options of one of the scene's strands.
  const Parameters& of(const Strand& strand) const;

 private:
  Parameters given_;
  std::map<std::size_t, Parameters> chosen_;  // by the number of elements
};

}  // namespace tress::simulation
