#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "contract/forms/energetics.h"

namespace tress::models {

/// Returns dT/dv . change, W: the rate of the kinetic energy by a change of the
/// accelerations. `v_typ`: typical sizes of v. Central differences of a quadratic
/// function are exact; only rounding remains.
inline double kinetic_rate(Energetics& of, double t, In q, In v, In change, In v_typ) {
  double size = 0;
  for (std::size_t i = 0; i < v.size(); ++i) {
    size = std::max(size, std::abs(change[i]) / v_typ[i]);
  }
  if (size == 0) return 0;
  std::vector<double> moved(v.begin(), v.end());
  const auto kinetic = [&](double time) {
    for (std::size_t i = 0; i < v.size(); ++i) moved[i] = v[i] + time * change[i];
    return of.energy(t, q, moved).kinetic;
  };
  return (kinetic(1 / size) - kinetic(-1 / size)) * size / 2;
}

}  // namespace tress::models
