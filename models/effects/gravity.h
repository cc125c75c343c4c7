#pragma once

#include "contract/parameters.h"
#include "math/vec3.h"
#include "models/effects/effect.h"
#include "models/motion/root_motion.h"

namespace tress::models {

/// Strength of gravity, for models that bring their own loads and for strands
/// without a scene.
inline constexpr Parameter gravity_parameter{.name = "gravity_m_s2",
                                             .help = "gravity along -z (m/s^2)",
                                             .number = 9.81,
                                             .min = 0,
                                             .max = 1e6};

/// Returns the parameters of the effect.
std::span<const Parameter> gravity_parameters();

/// Uniform gravity: f = m g per point, potential energy -m g.x (zero at the origin).
/// Reads mass and, for the potential only, position. O(points).
class Gravity final : public Effect {
 public:
  /// `acceleration` in m/s^2. Throws InputError unless finite.
  explicit Gravity(Vec acceleration);

  std::string_view name() const override { return "gravity"; }
  Needs needs() const override { return {}; }
  void add_load(double t, const Points& p, InOut f) const noexcept override;
  std::optional<Vec> uniform_acceleration() const noexcept override { return g_; }
  void add_derivatives(double, const Points&, double, double,
                       InOut) const noexcept override {}
  double potential(double t, const Points& p) const noexcept override;
  double power(double, const Points&) const noexcept override { return 0; }

 private:
  Vec g_;
};

/// Makes the effect.
std::unique_ptr<const Effect> make_gravity(const Parameters& parameters,
                                           const RootMotion& head);

}  // namespace tress::models
