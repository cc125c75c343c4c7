#pragma once

#include "contract/parameters.h"
#include "models/effects/effect.h"
#include "models/motion/root_motion.h"

namespace tress::models {

/// Returns the parameters of the effect.
std::span<const Parameter> linear_drag_parameters();

/// Viscous drag of still air on a thin strand and mass-proportional damping: f = -r v per
/// point with r = nu l + c m. The point carries the strand length l (m) and the mass m
/// (kg); nu is in kg/(m s) and c in 1/s. Purely dissipative: power = -r |v|^2, df/dv = -r
/// I. On a uniform strand, c is equivalent to adding c rho A to nu. O(points).
class LinearDrag final : public Effect {
 public:
  /// Throws InputError unless both are finite and >= 0.
  explicit LinearDrag(double nu, double mass_damping = 0);

  std::string_view name() const override { return "linear_drag"; }
  Needs needs() const override { return {.velocity = true, .derivatives = true}; }
  std::optional<Viscosity> viscosity() const noexcept override {
    return Viscosity{nu_, mass_damping_};
  }
  void add_load(double t, const Points& p, InOut f) const noexcept override;
  void add_derivatives(double t, const Points& p, double pos, double vel,
                       InOut blocks) const noexcept override;
  double potential(double, const Points&) const noexcept override { return 0; }
  double power(double t, const Points& p) const noexcept override;

 private:
  double rate(const Points& p, std::size_t i) const {
    return nu_ * p.length[i] + mass_damping_ * p.mass[i];
  }

  double nu_;            // kg/(m s)
  double mass_damping_;  // 1/s
};

/// Makes the effect.
std::unique_ptr<const Effect> make_linear_drag(const Parameters& parameters,
                                               const RootMotion& head);

}  // namespace tress::models
