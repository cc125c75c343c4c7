#pragma once

#include <concepts>

#include "models/strand/strain.h"

/// Strains of elements as a batch stores them: Vec3 or LinearStrainOf.
namespace tress::models {

/// Sets the strain in a lane.
template <class T>
void set_lane(LinearStrainOf<T>& to, int lane, const LinearStrain& x) {
  set_lane(to.mean, lane, x.mean);
  set_lane(to.half, lane, x.half);
}
/// Returns the strain in a lane.
template <class T>
LinearStrain lane_of(const LinearStrainOf<T>& x, int lane) {
  return {lane_of(x.mean, lane), lane_of(x.half, lane)};
}

/// Returns the sum of the entries.
template <class T>
T entries_sum(const Vec3<T>& x) {
  return x.x + x.y + x.z;
}
/// Returns the sum of the entries.
template <class T>
T entries_sum(const LinearStrainOf<T>& x) {
  return entries_sum(x.mean) + entries_sum(x.half);
}
/// Writes the three entries.
inline void store_entries(const Vec& x, double* to) { store3(x, to); }
/// Writes the six entries, those of the mean first.
inline void store_entries(const LinearStrain& x, double* to) {
  store3(x.mean, to);
  store3(x.half, to + 3);
}
/// Reads the entries of a strain: Vec or LinearStrain.
template <class Strain>
Strain entries(const double* from) {
  if constexpr (std::same_as<Strain, Vec>) {
    return load3(from);
  } else {
    return {load3(from), load3(from + 3)};
  }
}

}  // namespace tress::models
