#pragma once

#include <span>
#include <vector>

#include "models/head/head.h"
#include "simulation/head/scene_head.h"

namespace tress::simulation {

/// Speed (m/s) in which a strand's kinetic and elastic energies would be those of its
/// mass, the largest of some strands'.
double fastest(std::span<const models::HeadEnergy> each);

/// Finds strands of a head that do what physics rules out: numbers that are finite, but
/// wrong, where steps are too long. As Guard it looks from a frame that moves with the
/// clamps, which do no work there. With u the velocity of a point in it, w that of the
/// frame itself, a_w its acceleration, r the drag over mass, V the elastic energy, and s
/// = sqrt((sum m u^2 + 2 V)/m), friction aside, since (u + w).u >= -|w||u|,
///
///     s ds/dt = sum m (g - a_w - r (u + w)).u/m <= max(|g - a_w| + r |w|) s,
///
/// so that s grows by at most the integral of that maximum, over all places that a strand
/// reaches. In the world's frame sqrt((sum m |u + w|^2 + 2 V)/m) is at most max |w| more.
/// A tenth of all allows for the error of coarse but sound steps. Loads other than
/// gravity and drag have no place in this bound.
class HeadGuard {
 public:
  /// `speed`: what a run that is continued had gathered.
  explicit HeadGuard(HeadReach reach, double speed = 0);

  /// fastest() of all strands at t = 0.
  void start(double fastest);
  /// A step from t to t + h has been taken, in which the bound is looked at every
  /// `longest` s at least.
  void step(double t, double h, double longest);
  /// m/s, gathered so far.
  double speed() const { return speed_; }
  /// Whether a strand's energies at t are too large.
  bool breached(double t, const models::HeadEnergy& one) const;

 private:
  struct Bound {
    double speed, growth;  // of the frame; of s
  };
  Bound at(double t) const;

  HeadReach reach_;
  double speed_;
};

}  // namespace tress::simulation
