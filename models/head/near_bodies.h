#pragma once

#include <limits>
#include <span>
#include <variant>
#include <vector>

#include "models/effects/body.h"
#include "models/head/head_units.h"
#include "models/head/point_loads.h"

/// Bodies that strands of a head may touch: which reach the head, which some strands side
/// by side, and what they do to a point.
namespace tress::models {

/// A body that acts on a head at one time, and where it is, seen from the head's position
/// along the axes of the world.
struct NearBody {
  const RigidContact* contact;  // body and its law
  BodyPose pose;                // position and motion
};

/// Finds the bodies that reach the ball of all strands at t, seen from its centre.
inline void bodies_around(std::span<const RigidContact* const> all, double t,
                          const Ball& ball, std::vector<NearBody>& around) {
  around.clear();
  for (const RigidContact* contact : all) {
    BodyPose pose = contact->body.pose(t);
    if (!contact->body.reaches(pose, ball)) continue;
    pose.x = pose.x - ball.centre;
    around.push_back({contact, pose});
  }
}

/// Transforms a place into the axes of a body.
template <class T>
Vec3<T> in_body(const BodyPose& pose, const Vec3<T>& x) {
  return FrameOf<T>{pose.frame.e0, pose.frame.e1, pose.frame.e2}.back(x);
}

/// Finds those of `around` that reach a ball about `from` (m, from the head's position)
/// in some lane.
template <class T>
void bodies_near(std::span<const NearBody> around, const Vec3<T>& from, const T& radius,
                 std::vector<NearBody>& near) {
  near.clear();
  for (const NearBody& body : around) {
    const Vec3<T> seen = in_body(body.pose, from - Vec3<T>(body.pose.x));
    const T reach = radius + T(body.contact->body.offset());
    const bool reaches = std::visit(
        [&](const auto& shape) { return any_less(below(shape, seen).value, reach); },
        body.contact->body.shape());
    if (reaches) near.push_back(body);
  }
}

/// A body of this shape as points see it whose loads have components along `frame` (in
/// axes of the world), at the end of a step of h (s).
template <class T, class Shape>
class BodyTouch {
 public:
  /// Vector of these scalars.
  using Vec3T = Vec3<T>;

  /// Prepares the contact of points with a body.
  BodyTouch(const NearBody& body, const Shape& shape, const FrameOf<T>& frame, double h)
      : pose_(body.pose),
        law_(body.contact->law),
        shape_(shape),
        pos_(h * h),
        turn_(Matrix3<T>::columns(models::in_body(pose_, frame.e0),
                                  models::in_body(pose_, frame.e1),
                                  models::in_body(pose_, frame.e2))),
        moves_(pose_.frame.back(pose_.v)),
        turns_(pose_.frame.back(pose_.omega)),
        // The surface moves faster further out: du/dx = -omega x.
        by_place_{{T(h), T(pos_) * turns_.z, -(T(pos_) * turns_.y)},
                  {-(T(pos_) * turns_.z), T(h), T(pos_) * turns_.x},
                  {T(pos_) * turns_.y, -(T(pos_) * turns_.x), T(h)}} {}

  /// Returns the rotation from `frame` to the axes of the body.
  const Matrix3<T>& turn() const { return turn_; }
  /// A place (m) that is seen from the head's position, in the axes of the body.
  Vec3T in_body(const Vec3T& x) const {
    return models::in_body(pose_, x - Vec3T(pose_.x));
  }

  /// Adds to the load of a point at x (m, in_body). The point stands for `to_force`
  /// metres of strand per unit of force, and `to_block` per unit of mass. `some`: 1 in
  /// lanes with a load. velocity(): velocity of the point, m/s, evaluated only if the
  /// point may be touched.
  template <class Velocity>
  void touch(const Vec3T& x, const Velocity& velocity, const T& to_force,
             const T& to_block, PointLoad<T>& load, T& some) const {
    touched(x, velocity, [&](const T& outside, const Vec3T& force, const auto& slopes) {
      const T o(0);
      const Mat3Of<T> b = T(-pos_) * slopes.by_x - slopes.by_u * by_place_;
      const Symmetric3<T> symmetric{b.r0.x,
                                    b.r1.y,
                                    b.r2.z,
                                    T(0.5) * (b.r0.y + b.r1.x),
                                    T(0.5) * (b.r0.z + b.r2.x),
                                    T(0.5) * (b.r1.z + b.r2.y)};
      load.force =
          load.force + where_less(outside, o, to_force * turn_.back(force), Vec3T{});
      load.block =
          load.block +
          where_less(outside, o, to_block * congruent(turn_.transposed(), symmetric), {});
      some = where_less(outside, o, T(1), some);
    });
  }
  /// Adds the load of a point with its derivatives in units of length and speed.
  template <class Velocity>
  void touch(const Vec3T& x, const Velocity& velocity, const T& to_force,
             const HeadUnits& units, ExactLoad<T>& load, T& some) const {
    touched(x, velocity, [&](const T& outside, const Vec3T& force, const auto& slopes) {
      const T o(0);
      const Matrix3<T> by_u{{slopes.by_u.r0, slopes.by_u.r1, slopes.by_u.r2}},
          by_x{{slopes.by_x.r0, slopes.by_x.r1, slopes.by_x.r2}};
      const auto add = [&](const T& by, const Matrix3<T>& m, Matrix3<T>& to) {
        const Matrix3<T> turned = turn_.transposed() * m * turn_;
        to = to - where_less(outside, o, by * turned, Matrix3<T>{});
      };
      load.force =
          load.force + where_less(outside, o, to_force * turn_.back(force), Vec3T{});
      add(to_force * T(units.length), by_x - times_cross(by_u, turns_), load.by_x);
      add(to_force * T(units.speed()), by_u, load.by_u);
      some = where_less(outside, o, T(1), some);
    });
  }

 private:
  /// use(outside, force, slopes) in the axes of the body, if outside < 0 in some lane:
  /// loads are in those lanes.
  template <class Velocity, class Use>
  void touched(const Vec3T& x, const Velocity& velocity, const Use& use) const {
    const T o(0), reach(law_.offset);
    T bound(std::numeric_limits<typename T::Scalar>::lowest());
    if constexpr (requires { shape_.at_least(x); }) {
      bound = shape_.at_least(x) - reach;
      if (!any_less(bound, o)) return;
    }
    const NearestOf<T> near = shape_.nearest(x);
    // The bound again: rounding must not decide otherwise beside a lane that is near.
    const T outside = larger(bound, near.to.value - reach);
    if (!any_less(outside, o)) return;
    const Vec3T u = turn_ * velocity() - (moves_ + cross(turns_, x));
    ContactSlopesOf<T> slopes;
    const Vec3T force = law_.load(near.to, shape_.curvature(x, near), u, slopes);
    use(outside, force, slopes);
  }

  const BodyPose& pose_;
  const BodyContact& law_;
  const Shape& shape_;
  double pos_;
  Matrix3<T> turn_;
  Vec3T moves_, turns_;
  Mat3Of<T> by_place_;
};

}  // namespace tress::models
