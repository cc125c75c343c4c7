#pragma once

#include <vector>

#include "experiments/validation/test.h"
#include "models/strand/strand.h"

namespace tress::experiments::validation {

/// Equilibrium of a long straight isotropic rod, pulled and twisted at its ends [Coyne
/// 1990; van der Heijden & Thompson 2000]. The tilt from the line of the pull decays on
/// both sides of the middle. The tilt is cos(tilt) = 1 - (1 - cos(largest)) sech^2(decay
/// (s - 1/2)), in units of the rod's length and EI. Exact for an infinite rod. At the
/// ends of this one the tilt is 4 exp(-decay/2) sin(largest/2) or less.
struct LocalisedHelix {
  double largest_tilt;       // rad, in (0, pi)
  double decay;              // times L
  double bend_to_twist;      // EI/GJ
  double natural_twist = 0;  // times L; affects only the frames of a round section

  double tension() const;     // T L^2/EI
  double moment() const;      // M L/EI, along the pull
  double shortening() const;  // of the distance of the ends, over L
  double twist() const;       // times L
  double turning() const;     // of one end against the other, rad
  /// Darboux vector over s/L, times L; the frame at s = 0 is the clamp's.
  Vec darboux(double s) const;
};

std::vector<ValidationTest> localised_buckling_tests();

}  // namespace tress::experiments::validation
