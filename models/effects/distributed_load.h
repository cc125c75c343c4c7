#pragma once

#include <vector>

#include "contract/parameters.h"
#include "models/effects/effect.h"
#include "models/motion/factor_over_time.h"
#include "models/motion/root_motion.h"

namespace tress::models {

/// Returns the parameters of the effect.
std::span<const Parameter> distributed_load_parameters();

/// A force per length on the part of a strand between two arc lengths, over that of the
/// tip. With the factor c(t) and the unit tangent t, the load on a point that carries the
/// length l of the part is
///
///     f = c l (F + P t + B x t),   E = -c l F.x,   power = dE/dt at fixed x + c l (P t +
///     B x t).v
///
/// F keeps its direction, P follows the tangent. B x t is across the strand: a pressure
/// in the plane with normal B, or the force on a current in a magnetic field. A point
/// bears the load of the part of its own length that lies within the bounds. O(points).
class DistributedLoad final : public Effect {
 public:
  /// Parameters of the load.
  struct Settings {
    double from = 0, to = 1;                  // bounds, 0 root to 1 tip
    Vec force{};                              // F, N/m
    double along = 0;                         // P, N/m
    Vec turned{};                             // B, N/m
    std::vector<FactorOverTime::Row> rows{};  // c, in order of time; none: 1
  };
  /// Throws InputError on numbers out of range or not finite, and on times that do not
  /// increase.
  explicit DistributedLoad(Settings settings);

  std::string_view name() const override { return "distributed_load"; }
  Needs needs() const override {
    return {.position = !factor_.constant(),
            .velocity = follows(),
            .tangent = follows(),
            .directions = follows()};
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
  bool follows() const { return s_.along != 0 || norm(s_.turned) > 0; }
  /// Length of point i within the bounds, m.
  double length(const Points& p, std::size_t i) const noexcept;
  Vec following(const Vec& tangent) const noexcept {
    return s_.along * tangent + cross(s_.turned, tangent);
  }

  Settings s_;
  FactorOverTime factor_;
};

/// Makes the effect.
std::unique_ptr<const Effect> make_distributed_load(const Parameters& parameters,
                                                    const RootMotion& head);

}  // namespace tress::models
