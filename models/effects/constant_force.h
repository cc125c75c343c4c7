#pragma once

#include "contract/parameters.h"
#include "math/vec3.h"
#include "models/effects/effect.h"
#include "models/motion/root_motion.h"

namespace tress::models {

/// Returns the parameters of the effect.
std::span<const Parameter> constant_force_parameters();

/// A force constant in space and time: f = l p + m a per point with p in N/m and a in
/// N/kg, potential energy -f.x (zero at the origin). Reads length and mass and, for the
/// potential only, position. O(points).
class ConstantForce final : public Effect {
 public:
  /// Throws InputError unless all numbers are finite.
  ConstantForce(Vec per_length, Vec per_mass);

  std::string_view name() const override { return "constant_force"; }
  Needs needs() const override { return {}; }
  void add_load(double t, const Points& p, InOut f) const noexcept override;
  std::optional<Vec> uniform_acceleration() const noexcept override;
  void add_derivatives(double, const Points&, double, double,
                       InOut) const noexcept override {}
  double potential(double t, const Points& p) const noexcept override;
  double power(double, const Points&) const noexcept override { return 0; }

 private:
  Vec force(const Points& p, std::size_t i) const {
    return p.length[i] * per_length_ + p.mass[i] * per_mass_;
  }

  Vec per_length_;  // N/m
  Vec per_mass_;    // N/kg
};

/// Makes the effect.
std::unique_ptr<const Effect> make_constant_force(const Parameters& parameters,
                                                  const RootMotion& head);

}  // namespace tress::models
