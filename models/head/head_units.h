#pragma once

#include <cmath>

#include "contract/constants.h"

namespace tress::models {

/// Units of length, time and mass per length of a batch, in SI. In these units 1 is a
/// long hair, the time in which it falls by its length, and its mass. Numbers of any size
/// then fit into single precision.
struct HeadUnits {
  double length, time, density;  // m, s, kg/m
  /// Returns the units for a longest strand (m).
  static HeadUnits of(double longest) {
    return {longest, std::sqrt(longest / earth_gravity), 0};
  }
  /// Sets the unit of mass per length (kg/m) by the first strand added: `given` if it is
  /// positive, else the strand's own.
  void weigh(double given, double first) {
    if (density == 0) density = given > 0 ? given : first;
  }
  /// Returns the unit of bending stiffness, N m^2.
  double stiffness() const { return density * std::pow(length, 4) / (time * time); }
  /// Returns the unit of speed, m/s.
  double speed() const { return length / time; }
  /// Returns the unit of force, N.
  double force() const { return density * speed() * speed(); }
  /// Returns the unit of mass, kg.
  double mass() const { return density * length; }
};

}  // namespace tress::models
