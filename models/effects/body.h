#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "contract/parameters.h"
#include "models/contact/body_contact.h"
#include "models/effects/catalogue.h"
#include "models/effects/rigid_body.h"

namespace tress::models {

/// Returns the parameters of the effect.
std::span<const Parameter> body_parameters();
/// Returns which of them apply to which shape, motion and law.
std::span<const EffectUse> body_uses();
/// Returns the size of the grid of a body with shape = mesh and how far it is true to the
/// mesh, in words; nothing for other shapes. Throws InputError as make_body() does.
std::string surface_in_words(const Parameters& parameters);

/// Returns the prescribed motion of a body with these parameters; none: it is fixed, or
/// strands drive it. `head`: of the roots.
std::optional<RootMotion> body_motion(const Parameters& parameters,
                                      const RootMotion& head);

/// Result of Effect::rigid_contact(): per length of strand, `law`.
struct RigidContact {
  RigidBody body;   // shape and motion
  BodyContact law;  // law of contact
};

/// Contact of the strand with a rigid body and regularised friction. The load on a point
/// is l times that of BodyContact, a force per length, so the result does not depend on
/// the number of points. Points without length receive no force. The elastic part is the
/// potential. power() is that of damping and friction (<= 0 on a body at rest) plus that
/// of the body's motion against the elastic part, f_elastic.surface_velocity. O(points).
class Body final : public Effect {
 public:
  /// Throws InputError on numbers that are negative or not finite, and as RigidBody does.
  Body(BodyShape shape, const StrandPlace& place, const BodyContact& law,
       std::optional<RootMotion> head = {});

  std::string_view name() const override { return "body"; }
  Needs needs() const override {
    return {.position = true, .velocity = true, .derivatives = true};
  }
  const RigidContact* rigid_contact() const noexcept override {
    return more_.empty() ? &contact_ : nullptr;
  }
  bool reaches(double t, const Ball& ball) const noexcept override {
    return !more_.empty() || contact_.body.reaches(contact_.body.pose(t), ball);
  }
  void add_load(double t, const Points& p, InOut f) const noexcept override;
  void add_derivatives(double t, const Points& p, double pos, double vel,
                       InOut blocks) const noexcept override;
  double potential(double t, const Points& p) const noexcept override;
  double power(double t, const Points& p) const noexcept override;
  std::optional<double> penetration(double t, In x) const override {
    return contact_.body.penetration(t, x);
  }
  double surface_speed(double t, In x, double near) const override {
    return contact_.body.surface_speed(t, x, near);
  }
  double next_breakpoint(double t) const noexcept override {
    return contact_.body.next_breakpoint(t);
  }
  std::optional<Outline> outline(double t) const override {
    return contact_.body.outline(t);
  }

  /// Returns the body's position and motion at t (s).
  BodyPose pose(double t) const { return contact_.body.pose(t); }
  /// Returns the body and its law.
  const RigidContact& contact_on_points() const { return contact_; }

  /// Returns a copy for one strand whose points meet the surface `more` (m, one each)
  /// farther away than its radius. Each point then has the depth at rest that its force
  /// requires.
  std::shared_ptr<const Body> with_offsets(std::vector<double> more) const;

 private:
  /// The law at a point.
  BodyContact law(std::size_t point) const {
    BodyContact own = contact_.law;
    if (point < more_.size()) own.offset += more_[point];
    return own;
  }

  RigidContact contact_;
  std::vector<double> more_;
};

/// With regularised friction, as a DrivenBody if strands drive it, or as ExactBody.
std::unique_ptr<const Effect> make_body(const Parameters& parameters,
                                        const RootMotion& head);

}  // namespace tress::models
