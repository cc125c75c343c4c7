#pragma once

#include "contract/parameters.h"
#include "math/vec3.h"
#include "models/effects/effect.h"
#include "models/motion/root_motion.h"

namespace tress::models {

/// Returns the parameters of the effect.
std::span<const Parameter> tether_parameters();

/// Pulls one point of the strand towards a moving place X(t) = target + amplitude sin(2
/// pi frequency t). With d = X - x and the strength s(t) in [0, 1]:
///
///     f = s (k d + P d/sqrt(|d|^2 + soft^2) + c (X' - v))
///     E = s (k |d|^2/2 + P sqrt(|d|^2 + soft^2)),  power = s c (X' - v).v + dE/dt at
///     fixed x
///
/// with a spring k (N/m), a damper c (N s/m), and a pull of P (N) that fades within
/// `soft` of the target. The strength s rises from 0 to 1 in `ramp` seconds from t_on and
/// falls back from t_off as 3 y^2 - 2 y^3, C^1. The tethered point carries the arc
/// position `at` (0 root, 1 tip) along the accumulated lengths of the points; finding it
/// is O(points).
class Tether final : public Effect {
 public:
  /// Parameters of the tether.
  struct Settings {
    double at = 1;              // place along the strand, 0 root to 1 tip
    double stiffness = 0;       // N/m
    double damping = 0;         // N s/m
    double pull = 0;            // N
    double soft = 1e-3;         // m, > 0
    Vec target{}, amplitude{};  // m
    double frequency = 0;       // 1/s
    double on = 0, off = 0;     // s, off >= on
    double ramp = 1e-2;         // s, > 0
  };
  /// Throws InputError on numbers outside these ranges, negative or not finite.
  explicit Tether(const Settings& settings);

  std::string_view name() const override { return "tether"; }
  Needs needs() const override {
    return {.position = true, .velocity = true, .derivatives = true};
  }
  void add_load(double t, const Points& p, InOut f) const noexcept override;
  void add_derivatives(double t, const Points& p, double pos, double vel,
                       InOut blocks) const noexcept override;
  double potential(double t, const Points& p) const noexcept override;
  double power(double t, const Points& p) const noexcept override;
  double next_breakpoint(double t) const noexcept override;

  /// Position of the target, for pictures.
  Vec target(double t) const;
  /// Index of the tethered point.
  std::size_t held(const Points& p) const;

 private:
  Vec target_rate(double t) const;
  double strength(double t) const;
  double strength_rate(double t) const;
  double soft_length(const Vec& d) const;
  Vec attraction(const Vec& d) const;  // load of spring and pull at s = 1
  /// Returns the energy at s = 1, J.
  double energy(const Vec& d) const;

  Settings s_;
};

/// Makes the effect.
std::unique_ptr<const Effect> make_tether(const Parameters& parameters,
                                          const RootMotion& head);

}  // namespace tress::models
