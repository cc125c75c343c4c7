#pragma once

#include <vector>

#include "contract/parameters.h"
#include "models/effects/effect.h"
#include "models/motion/factor_over_time.h"
#include "models/motion/root_motion.h"

namespace tress::models {

/// Returns the parameters of the effect.
std::span<const Parameter> point_force_parameters();

/// A force on one place of the strand, dead or following its tangent. The place has the
/// arc length `at` times that of the tip. With the factor c(t):
///
///     f = c (F + P t),   E = -c F.x,   power = dE/dt at fixed x + c P t.v
///
/// F is a force in the world (N), P a force along the unit tangent t (N). With the shares
/// w_k of PlaceShares, point k bears w_k f, so that the work is the same. O(points).
class PointForce final : public Effect {
 public:
  using Row = FactorOverTime::Row;  // factor at a time
  /// Parameters of the force.
  struct Settings {
    double at = 1;            // place along the strand, 0 root to 1 tip
    Vec force{};              // dead force, N
    double follower = 0;      // force along the tangent, from root to tip, N
    std::vector<Row> rows{};  // in order of time; none: factor 1
  };
  /// Throws InputError on numbers out of range or not finite, and on times that do not
  /// increase.
  explicit PointForce(Settings settings);

  std::string_view name() const override { return "point_force"; }
  Needs needs() const override {
    const bool follows = s_.follower != 0;
    return {.position = !factor_.constant(),
            .velocity = follows,
            .tangent = follows,
            .directions = follows};
  }
  void add_load(double t, const Points& p, InOut f) const noexcept override;
  void add_derivatives(double, const Points&, double, double,
                       InOut) const noexcept override {}
  void add_direction_derivatives(double t, const Points& p, double factor,
                                 InOut blocks) const noexcept override;
  double potential(double t, const Points& p) const noexcept override;
  double power(double t, const Points& p) const noexcept override;
  double next_breakpoint(double t) const noexcept override {
    return factor_.next_breakpoint(t);
  }

 private:
  Settings s_;
  FactorOverTime factor_;
};

/// Makes the effect.
std::unique_ptr<const Effect> make_point_force(const Parameters& parameters,
                                               const RootMotion& head);

}  // namespace tress::models
