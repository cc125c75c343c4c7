#pragma once

#include <memory>
#include <vector>

#include "contract/forms/material_points.h"
#include "models/effects/effect.h"

namespace tress::simulation {

/// Gauges the depth of strands in bodies after every step. A strand is the polygon
/// through its material points. Between two points the depth is sampled at distances of
/// at most half the thickness of the thinnest body, in 64 pieces at most.
class BodyDepth {
 public:
  /// Gauges the depth in those of the effects that are bodies.
  BodyDepth(const models::Effects& effects, MaterialPoints& points);

  /// Returns true if there is a body.
  bool any() const { return !bodies_.empty(); }
  /// Looks at a state of the system that `points` are of.
  void look(MaterialPoints& points, double t, In q);

  double deepest = 0;  // m, largest depth so far

 private:
  std::vector<std::shared_ptr<const models::Effect>> bodies_;
  double spacing_;           // m
  std::vector<int> before_;  // each point along its strand, -1: none
  std::vector<double> x_, places_;
};

}  // namespace tress::simulation
