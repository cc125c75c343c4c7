#pragma once

#include <memory>
#include <optional>

#include "models/effects/rigid_body.h"

namespace tress::models {

/// A body that strands touch by the impulses of StrandFriction instead of by loads: it is
/// drawn and measured as Body, and exerts no load. Rigid; Coulomb's coefficient of its
/// own.
class Obstacle final : public Effect {
 public:
  /// Takes the radius of the strand as `offset` (m).
  Obstacle(std::shared_ptr<const RigidBody> body, double offset, double friction);

  std::string_view name() const override { return "body"; }
  Needs needs() const override { return {}; }
  void add_load(double, const Points&, InOut) const noexcept override {}
  void add_derivatives(double, const Points&, double, double,
                       InOut) const noexcept override {}
  double potential(double, const Points&) const noexcept override { return 0; }
  double power(double, const Points&) const noexcept override { return 0; }
  std::optional<double> penetration(double t, In x) const override {
    return body_->penetration(t, x);
  }
  double surface_speed(double t, In x, double near) const override {
    return body_->surface_speed(t, x, near);
  }
  std::optional<Outline> outline(double t) const override { return body_->outline(t); }
  /// Returns shape, place and motion.
  const RigidBody& body() const { return *body_; }

  /// Returns Coulomb's coefficient.
  double friction() const { return friction_; }
  /// Distance of points (m) that may not miss it between them.
  double spacing() const { return body_->least_radius() + offset_; }

  /// The tangent plane at which a point meets the surface, at the end of a step.
  struct Plane {
    Vec normal;         // outwards, of length 1
    double height;      // of points that just touch, along the normal, m
    Vec velocity;       // of the surface in the step, where the point was at its start
    double gap_before;  // of the point at the start of the step, m
    /// Returns the distance of a point from the plane, m.
    double gap(const Vec& x) const { return dot(normal, x) - height; }
  };
  /// The step of h (s) that ends at time t.
  class Step {
   public:
    /// Prepares a step of h (s) that ends at t.
    Step(const Obstacle& of, double t, double h);
    /// Returns the plane of contact of a point that moves straight from x0 to x1, if it
    /// ends nearer to the surface than `reach` or was inside on its way. The plane is
    /// where the point entered, or below its end.
    std::optional<Plane> touch(const Vec& x0, const Vec& x1, double reach) const;

   private:
    const Obstacle& of_;
    double h_;
    BodyPose before_, after_;
  };

 private:
  /// Distance of a point's surface from the body's, from a place in its frame.
  bool near(const Vec& x, double reach, Distance& to) const;

  std::shared_ptr<const RigidBody> body_;
  double offset_;  // m, of the strand's axis
  double friction_;
};

}  // namespace tress::models
