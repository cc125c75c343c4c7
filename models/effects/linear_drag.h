#pragma once

#include "models/effects/effect.h"

namespace tress {

/// Viscous drag of still air on a thin strand: f = -nu l v per point, with l the strand
/// length (m) that the point carries and nu in kg/(m s). It only dissipates:
/// power = -nu l |v|^2, df/dv = -nu l I. O(points).
class LinearDrag final : public Effect {
 public:
  /// Throws InputError unless nu is finite and >= 0.
  explicit LinearDrag(double nu);

  std::string_view name() const override { return "linear_drag"; }
  Needs needs() const override { return {.velocity = true, .derivatives = true}; }
  void add_load(double t, const Points& p, InOut f) const noexcept override;
  void add_derivatives(double t, const Points& p, double pos, double vel,
                       InOut blocks) const noexcept override;
  double potential(double, const Points&) const noexcept override { return 0; }
  double power(double t, const Points& p) const noexcept override;

 private:
  double nu_;
};

}  // namespace tress
