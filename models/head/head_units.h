#pragma once

#include <cmath>

#include "contract/constants.h"

namespace tress::models {

/// Units of length, time and mass per length of a batch, in SI. In these units 1 is a
/// long hair, the time in which it falls by its length, and its mass. Numbers of any size
/// then fit into single precision.
struct HeadUnits {
  double length, time, density;  // m, s, kg/m
  static HeadUnits of(double longest) {
    return {longest, std::sqrt(longest / earth_gravity), 0};
  }
  /// Sets the unit of mass per length (kg/m) by the first strand added: `given` if it is
  /// positive, else the strand's own.
  void weigh(double given, double first) {
    if (density == 0) density = given > 0 ? given : first;
  }
  double stiffness() const { return density * std::pow(length, 4) / (time * time); }
  double speed() const { return length / time; }
  double force() const { return density * speed() * speed(); }
  double mass() const { return density * length; }
};

}  // namespace tress::models
