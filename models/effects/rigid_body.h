#pragma once

#include <limits>
#include <optional>
#include <variant>

#include "models/contact/body_shapes.h"
#include "models/contact/distance_grid.h"
#include "models/effects/effect.h"
#include "models/motion/root_motion.h"

namespace tress::models {

/// Shapes of bodies, in their own frames.
using BodyShape = std::variant<Plane, Sphere, Capsule, Ellipsoid, DistanceGrid>;

/// Position and motion of a body.
struct BodyPose {
  Vec x;        // of its origin, m
  Frame frame;  // its axes
  Vec v;        // m/s
  Vec omega;    // rad/s

  /// Returns the velocity of the surface at a place, m/s.
  Vec surface_velocity(const Vec& at) const { return v + cross(omega, at - x); }
};

/// Shape and motion of a body that strands touch.
class RigidBody {
 public:
  /// Constructs a body at `place`. `offset`: radius of the strand (m). `motion`: that of
  /// the head, or its own; the body is at `place` while it is at rest, and stays there
  /// without a motion. Throws InputError on numbers that are negative or not finite
  /// and on a frame that is not a rotation. Also throws on a grid whose surface comes
  /// within two spacings of contact with its second layer, where contact would go
  /// undetected.
  RigidBody(BodyShape shape, const StrandPlace& place, double offset,
            std::optional<RootMotion> motion);

  /// Returns position and motion at t (s), as after the teleport at `since`.
  BodyPose pose(double t, double since = by_time) const;
  /// Returns the first breakpoint of the motion after t (s), or infinity.
  double next_breakpoint(double t) const {
    return motion_ ? motion_->next_breakpoint(t)
                   : std::numeric_limits<double>::infinity();
  }
  /// Empty for a distance grid.
  std::optional<Outline> outline(double t) const;
  /// Largest depth (m) of the strand's surface in the body over the points at x.
  double penetration(double t, In x) const;
  /// Largest speed (m/s) of the surface, at those of the points at x that are in contact
  /// or less than `near` (m) from it.
  double surface_speed(double t, In x, double near) const;

  /// Returns the shape.
  const BodyShape& shape() const { return shape_; }
  double offset() const { return offset_; }  // m
  /// Whether points of the ball may be in contact.
  bool reaches(const BodyPose& now, const Ball& ball) const;

  /// Returns the least radius of curvature where it is known, m; infinity: flat.
  double least_radius() const;
  /// Returns the distance from a place in the body's frame, if it is below `reach`.
  std::optional<Distance> distance(const Vec& x, double reach) const;

  /// A point of the strand near the surface, in the frame of the body.
  struct Near {
    std::size_t point = 0;  // index of the point
    Vec x, u;  // u: velocity relative to the surface; 0 if velocities were not asked for
    Distance to;     // distance to the surface
    Mat3 curvature;  // of the distance; 0 unless asked for
  };
  /// Quantities that for_near() computes: `position`, also `velocity`, also
  /// `curvature`.
  enum class With { position, velocity, curvature };
  /// Calls see(Near) for the points whose distance is below reach(point), in order.
  template <With with, class Reach, class See>
  void for_near(const BodyPose& now, const Points& p, Reach reach, See see) const {
    std::visit(
        [&](const auto& shape) {
          for (std::size_t i = 0; i < p.length.size(); ++i) {
            const Vec world = load3(&p.x[3 * i]);
            Near at;
            at.point = i;
            at.x = now.frame.back(world - now.x);
            NearestOf<double> found;
            if (!nearest(shape, at.x, reach(i), found)) continue;
            at.to = found.to;
            if constexpr (with != With::position) {
              at.u = now.frame.back(load3(&p.v[3 * i]) - now.surface_velocity(world));
            }
            if constexpr (with == With::curvature) {
              at.curvature = shape.curvature(at.x, found);
            }
            see(at);
          }
        },
        shape_);
  }

 private:
  template <class See>
  void for_within(double reach, const BodyPose& now, In x, See see) const;
  /// The place on a shape, if the distance is below `reach`; most others are excluded
  /// without a search.
  template <class Shape>
  static bool nearest(const Shape& shape, const Vec& x, double reach,
                      NearestOf<double>& at) {
    if constexpr (requires { shape.at_least(x); }) {
      if (shape.at_least(x) >= reach) return false;
    }
    at = shape.nearest(x);
    return at.to.value < reach;
  }

  BodyShape shape_;
  StrandPlace place_;
  double offset_;  // m
  std::optional<RootMotion> motion_;
};

}  // namespace tress::models
