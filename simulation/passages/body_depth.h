#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "contract/forms/material_points.h"
#include "models/effects/effect.h"
#include "simulation/passages/body_passages.h"

namespace tress::simulation {

/// Gauges the depth of strands in bodies after every step, at the places of StrandPlaces,
/// and finds strands that passed through a body within the step.
class BodyDepth {
 public:
  /// Gauges the depth in those of the effects that are bodies.
  BodyDepth(const models::Effects& effects, MaterialPoints& points);

  /// Returns true if there is a body.
  bool any() const { return !bodies_.empty(); }
  /// Looks at a step of the system that `points` are of, from old_q at `from` to q at t.
  void look(MaterialPoints& points, double from, In old_q, double t, In q);

  /// Findings so far.
  struct Seen {
    double deepest = 0;                   // m, at the ends of steps and on passages
    std::optional<MissedContact> missed;  // the first
  };
  Seen seen;  // so far

 private:
  BodyPassages passages_;
  std::vector<std::shared_ptr<const models::Effect>> bodies_;
  double t_ = 0;                       // s, end of the last step
  std::vector<double> q_, x_, old_x_;  // at the end of the last step; (3 points)
};

}  // namespace tress::simulation
