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

/// Position and motion of a body.
struct BodyPose {
  Vec x;        // of its origin, m
  Frame frame;  // its axes
  Vec v;        // m/s
  Vec omega;    // rad/s

  Vec surface_velocity(const Vec& at) const { return v + cross(omega, at - x); }
};

/// Contact of the strand with a rigid body: per point, l times the load of BodyContact, a
/// force per length, so the result does not depend on the number of points; points
/// without length receive no force. The elastic part is the potential; power is that of
/// damping and friction (<= 0 on a body at rest) plus that of the body's motion against
/// the elastic part, f_elastic.surface_velocity. O(points).
class Body final : public Effect {
 public:
  /// `head`: the motion that the body follows; the body is at `place` while the head is
  /// at rest, and stays there if no head is given. Throws InputError on numbers that are
  /// negative or not finite, a frame that is not a rotation, and a grid whose surface
  /// comes within two spacings of contact with its second layer, where contact would go
  /// undetected.
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
  /// Empty for a distance grid.
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
