#pragma once

#include <memory>
#include <span>
#include <variant>
#include <vector>

#include "contract/forms/driven_bodies.h"
#include "models/effects/body.h"

namespace tress::models {

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

/// A body that moves freely in space. Its centre of mass is the origin of its frame, and
/// the axes of the frame are its principal axes.
struct FreeBody {
  double mass = 1;       // kg
  Vec inertia{1, 1, 1};  // principal moments of inertia, kg m^2
  Vec velocity, spin;    // velocity (m/s) and angular velocity (rad/s) at t = 0
};

/// Motion that a driven body admits.
using BodyDrive = std::variant<Bearing, FreeBody>;

/// Force on a body and moment about its reference point.
struct BodyWrench {
  Vec force;   // N
  Vec moment;  // N m
};

/// A coordinate of a body: the motion of the body when it changes.
struct Screw {
  Vec turn;   // rotation
  Vec shift;  // displacement of the reference point
  Vec spin;   // change of the angular velocity at constant rates of the coordinates
};

/// Contact of a strand with a body that it drives: a Body in the frame that moves with
/// it. The DrivenSystem that owns the coordinates of the body sets its motion before it
/// evaluates the strand, and reads the wrench of the contact forces.
///
/// Let r be the place of a point relative to the reference point, and V and omega the
/// velocities of the body. The force f(x, u) on the point keeps its form if points and
/// body move together. It depends on the velocity relative to the surface,
/// w = u - V - omega x r. Derivatives by the body's motion thus follow from those by the
/// point's.
/// With the screw (e, d, omega_q) of a coordinate q and s = d + e x r:
///
///     df/dq = e x f - df/dx s - df/du (omega x (e x r) + e x w + omega_q x r),
///     df/dq' = -df/du s.
///
/// Of one strand or block of strands: the motion and what is recorded change in const
/// functions, so instances must not be shared by systems or threads.
class DrivenBody final : public Effect {
 public:
  /// `body` must be at rest. Throws InputError on numbers that are not finite, a bearing
  /// without an axis and a damping that is negative. Also throws on a mass or an inertia
  /// that is not positive, and on principal moments that no body has.
  DrivenBody(Body body, const BodyDrive& drive);

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

  /// Returns the bearing or the free body; an axis has length 1.
  const BodyDrive& drive() const { return drive_; }
  /// Returns the place of the body's shape at the start.
  BodyPose place() const { return body_.pose(0); }
  /// Returns the motion at the start.
  const DrivenBodies::Motion& start() const { return start_; }
  /// Sets the motion.
  void move_to(const DrivenBodies::Motion& now) const { now_ = now; }

  // For the equations of the body and their derivatives.
  /// Loads of the next residual of the strand are recorded.
  void record() const;
  /// Loads act as the law says and are not recorded.
  void act() const { mode_ = Mode::acts; }
  /// Returns the wrench of the loads that are recorded, and ends the record: loads that
  /// follow begin another. 0 where loads are not recorded.
  BodyWrench wrench() const;
  /// Returns the wrench of the last record.
  BodyWrench recorded() const;
  /// Returns true if a recorded load is not 0.
  bool touched() const;

  /// Derivatives of the recorded loads f, with w.pos times those by places and
  /// coordinates, w.vel times those by their rates.
  struct Slopes {
    /// Derivatives by one coordinate, 3 numbers a point.
    struct Of {
      std::vector<double> by_motion;  // of f by the coordinate
      std::vector<double> load;       // of s . f by the motion of points
      std::vector<double> rate;       // w.pos times that by velocities
    };
    std::vector<Of> of;       // by the coordinates
    std::vector<double> own;  // of s . f by the coordinates at fixed s, by columns
  };
  /// Computes the derivatives.
  void slopes(double t, Weights w, std::span<const Screw> screws, Slopes& to) const;
  /// Replaces the loads of the next residual by `loads` times `factor`, in the order of
  /// those recorded; none: by 0. `loads` must outlive it.
  void replace(In loads, double factor) const;

 private:
  enum class Mode { acts, records, replaced };
  /// Returns the points, seen in the frame of the body.
  Points in_frame(const Points& p) const;
  /// Returns the velocity of the surface at a place.
  Vec surface_velocity(const Vec& x) const {
    return now_.v + cross(now_.omega, x - now_.x);
  }
  void law(double t, const Points& p, InOut f) const;
  void law_slopes(double t, const Points& p, double pos, double vel, InOut blocks) const;
  void place_in_frame(In x) const;

  Body body_;
  BodyDrive drive_;
  DrivenBodies::Motion start_;
  mutable DrivenBodies::Motion now_;
  mutable Mode mode_ = Mode::acts;
  mutable bool read_ = false;          // the record has ended
  mutable std::vector<double> x_, v_;  // in the frame of the body
  mutable std::vector<double> load_, blocks_, block_, by_velocity_;  // scratch
  // The record.
  mutable std::vector<double> places_, velocities_, lengths_, loads_;
  mutable In given_;
  mutable double factor_ = 0;
  mutable std::size_t next_ = 0;  // point of `given_`
};

/// Returns the effects that are driven bodies.
std::vector<const DrivenBody*> driven_bodies(const Effects& effects);

}  // namespace tress::models
