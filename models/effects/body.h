#pragma once

#include <optional>
#include <variant>

#include "contract/parameters.h"
#include "models/effects/body_contact.h"
#include "models/effects/body_shapes.h"
#include "models/effects/distance_grid.h"
#include "models/effects/effect.h"
#include "models/motion/root_motion.h"

namespace tress::models {

std::span<const Parameter> body_parameters();

using BodyShape = std::variant<Plane, Sphere, Capsule, Ellipsoid, DistanceGrid>;

/// Where a body is and how it moves.
struct BodyPose {
  Vec x;        // of its origin, m
  Frame frame;  // its axes
  Vec v;        // m/s
  Vec omega;    // rad/s

  Vec surface_velocity(const Vec& at) const { return v + cross(omega, at - x); }
};

/// Contact of the strand with a rigid body: per point l times the load of BodyContact,
/// which is a force per length, so that the answer does not depend on how many points a
/// strand has; points that carry no length feel nothing. The elastic part is the
/// potential; power is what damping and friction take (<= 0 on a body at rest) and the
/// work of the body's motion against the elastic part, f_elastic.surface_velocity.
/// O(points).
class Body final : public Effect {
 public:
  /// `head`: the motion that the body follows, which stands at `place` while the head is
  /// at its rest; nothing: it stays there. Throws InputError on numbers that are negative
  /// or not finite, a frame that is no rotation, and a grid whose surface comes within
  /// two spacings of contact with its second layer, where it could not be felt any more.
  Body(BodyShape shape, const StrandPlace& place, const BodyContact& law,
       std::optional<RootMotion> head = {});

  std::string_view name() const override { return "body"; }
  Needs needs() const override {
    return {.position = true, .velocity = true, .derivatives = true};
  }
  void add_load(double t, const Points& p, InOut f) const noexcept override;
  void add_derivatives(double t, const Points& p, double pos, double vel,
                       InOut blocks) const noexcept override;
  double potential(double t, const Points& p) const noexcept override;
  double power(double t, const Points& p) const noexcept override;

  std::optional<double> penetration(double t, In x) const override;
  /// None of a distance grid.
  std::optional<Outline> outline(double t) const override;

  BodyPose pose(double t) const;

 private:
  BodyShape shape_;
  StrandPlace place_;
  BodyContact law_;
  std::optional<RootMotion> head_;
};

std::unique_ptr<const Effect> make_body(const Parameters& parameters,
                                        const RootMotion& head);

}  // namespace tress::models
