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
/// strands turn it. `head`: of the roots.
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

/// The bearing of a body that turns about an axis fixed in space, and what acts on it in
/// addition to strands.
struct Bearing {
  Vec axis{0, 0, 1};   // direction, any length
  Vec pivot;           // place of a point of the axis, m
  double inertia = 1;  // moment of inertia about the axis, kg m^2
  double damping = 0;  // moment per angular velocity, N m s
  double moment = 0;   // prescribed moment about the axis, N m
  double speed = 0;    // angular velocity at t = 0, rad/s
};

/// Contact of a strand with a body that turns about a bearing: a Body in the frame that
/// turns with it. The TurningSystem that owns the angle and the angular velocity sets
/// them before it evaluates the strand, and reads the moment of the contact forces.
///
/// At the angle theta and the angular velocity omega, let r be the place of a point
/// relative to the pivot, e the axis and s = e x r. The force f(x, u) on the point keeps
/// its form if points and body turn together, and depends on the velocity relative to the
/// surface, u - omega s. Derivatives by the body's motion thus follow from those by the
/// point's:
///
///     df/dtheta = e x f - df/dx s - df/du (e x u),     df/domega = -df/du s.
///
/// Of one strand or block of strands: `theta`, `omega` and what is recorded change in
/// const functions, so instances must not be shared by systems or threads.
class TurningBody final : public Effect {
 public:
  /// `body` must be at rest. Throws InputError on a bearing that is not finite or has no
  /// axis, on an inertia that is not positive and a damping that is negative.
  TurningBody(Body body, const Bearing& bearing);

  std::string_view name() const override { return "body"; }
  Needs needs() const override { return body_.needs(); }
  void add_load(double t, const Points& p, InOut f) const noexcept override;
  void add_derivatives(double t, const Points& p, double pos, double vel,
                       InOut blocks) const noexcept override;
  double potential(double t, const Points& p) const noexcept override;
  /// Returns the power of damping and friction between strand and body, W. The work of
  /// the surface on the strand is that of the strand on the body.
  double power(double t, const Points& p) const noexcept override;
  std::optional<double> penetration(double t, In x) const override;
  double surface_speed(double t, In x, double near) const override;
  std::optional<Outline> outline(double t) const override;

  /// Returns the bearing; its axis has length 1.
  const Bearing& bearing() const { return bearing_; }
  /// Sets the angle (rad) and the angular velocity (rad/s).
  void turn_to(double angle, double speed) const;

  // For the equations of the body and their derivatives.
  /// Loads of the next residual of the strand are recorded.
  void record() const;
  /// Loads act as the law says and are not recorded.
  void act() const { mode_ = Mode::acts; }
  /// Returns the moment of the recorded loads on the body about the axis, N m.
  double moment() const;
  /// Returns true if a recorded load is not 0.
  bool touched() const;

  /// Derivatives of the recorded loads f, with w.pos times those by places and the angle,
  /// w.vel times those by velocities and the angular velocity.
  struct Slopes {
    std::vector<double> by_turn;  // of f by the body's motion, 3 a point
    std::vector<double> moment;   // of -moment() by the motion of points, 3 a point
    std::vector<double> rate;     // w.pos times that by velocities, 3 a point
    double own = 0;               // of -moment() by the body's motion
  };
  /// Computes the derivatives.
  void slopes(double t, Weights w, Slopes& to) const;
  /// Replaces the loads of the next residual by `loads` times `factor`, in the order of
  /// the record; none: 0. `loads` must outlive it.
  void replace(In loads, double factor) const;

 private:
  enum class Mode { acts, records, replaced };
  /// Returns the points, seen in the frame of the body.
  Points in_frame(const Points& p) const;
  Vec lever(const Vec& x) const { return cross(bearing_.axis, x - bearing_.pivot); }
  void law(double t, const Points& p, InOut f) const;
  void law_slopes(double t, const Points& p, double pos, double vel, InOut blocks) const;
  void place_in_frame(In x) const;

  Body body_;
  Bearing bearing_;
  mutable double speed_ = 0;  // rad/s
  mutable double angle_ = 0;  // rad
  mutable Frame turn_;        // rotation by the angle
  mutable Mode mode_ = Mode::acts;
  mutable std::vector<double> x_, v_;                  // in the frame of the body
  mutable std::vector<double> load_, blocks_, block_;  // scratch
  // The record.
  mutable std::vector<double> places_, velocities_, lengths_, loads_;
  mutable In given_;
  mutable double factor_ = 0;
  mutable std::size_t next_ = 0;  // point of `given_`
};

/// The effects that are turning bodies.
std::vector<const TurningBody*> turning_bodies(const Effects& effects);

/// With regularised friction, as a TurningBody if it turns, or as ExactBody.
std::unique_ptr<const Effect> make_body(const Parameters& parameters,
                                        const RootMotion& head);

}  // namespace tress::models
