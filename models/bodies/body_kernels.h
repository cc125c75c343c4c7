#pragma once

#include "math/mat3.h"
#include "models/bodies/rotation_chart.h"
#include "models/effects/driven_body.h"

/// Equations of driven bodies over any scalar, for BodySystem.
namespace tress::models {

/// Motion of a body, world components.
template <class T>
struct BodyMotionOf {
  Vec3<T> x, v, a;       // of the reference point
  FrameOf<T> turn;       // rotation since the start
  Vec3<T> omega, alpha;  // angular velocity and acceleration
};

/// A body that turns about a bearing.
struct TurningKernel {
  static constexpr int size = 1;  // coordinates: the angle
  Bearing bearing;                // its axis has length 1

  /// Returns the motion at coordinates, their rates and second derivatives.
  template <class T>
  BodyMotionOf<T> motion(const T* q, const T* v, const T* a) const {
    using std::cos;
    using std::sin;
    const Vec3<T> e(bearing.axis);
    const T c = cos(q[0]), s = sin(q[0]), o(0), one(1);
    const auto turned = [&](const Vec3<T>& x) {
      return c * x + s * cross(e, x) + ((one - c) * dot(e, x)) * e;
    };
    BodyMotionOf<T> m;
    m.x = Vec3<T>(bearing.pivot);
    m.turn = {turned({one, o, o}), turned({o, one, o}), turned({o, o, one})};
    m.omega = v[0] * e;
    m.alpha = a[0] * e;
    return m;
  }
  /// Writes the generalised force r of a force and a moment at the reference point.
  template <class T>
  void project(const T*, const Vec3<T>&, const Vec3<T>& moment, T* r) const {
    r[0] = dot(Vec3<T>(bearing.axis), moment);
  }
  /// Writes r = M a - f, without the forces of strands.
  template <class T>
  void equations(const T*, const T* v, const T* a, T* r) const {
    r[0] = bearing.inertia * a[0] + bearing.damping * v[0] - T(bearing.moment);
  }
};

/// A body that moves freely.
struct FreeKernel {
  static constexpr int size = 6;  // coordinates: place and rotation vector
  FreeBody body;                  // mass, and the motion at the start
  Mat3 inertia;                   // about the axes of the world, turned with the body
  Vec gravity;                    // acceleration, m/s^2
  Frame reference{};              // rotation from which the rotation vector counts

  /// Returns the rotation of the rotation vector.
  template <class T>
  RotationChart<T> chart(const T* q) const {
    return RotationChart<T>(Vec3<T>(q[3], q[4], q[5]));
  }
  /// Returns a vector with components in the reference in those of the world.
  template <class T>
  Vec3<T> world(const Vec3<T>& x) const {
    return FrameOf<T>{Vec3<T>(reference.e0), Vec3<T>(reference.e1),
                      Vec3<T>(reference.e2)} *
           x;
  }
  /// Returns a vector with components in the world in those of the reference.
  template <class T>
  Vec3<T> in_reference(const Vec3<T>& x) const {
    return {dot(Vec3<T>(reference.e0), x), dot(Vec3<T>(reference.e1), x),
            dot(Vec3<T>(reference.e2), x)};
  }
  /// Returns the angular momentum of an angular velocity, both in the body's components.
  template <class T>
  Vec3<T> momentum(const Vec3<T>& omega) const {
    return {dot(Vec3<T>(inertia.r0), omega), dot(Vec3<T>(inertia.r1), omega),
            dot(Vec3<T>(inertia.r2), omega)};
  }

  /// Returns the motion at coordinates, their rates and second derivatives.
  template <class T>
  BodyMotionOf<T> motion(const T* q, const T* v, const T* a) const {
    const RotationChart<T> at = chart(q);
    const Vec3<T> rate(v[3], v[4], v[5]), second(a[3], a[4], a[5]);
    const FrameOf<T> turn = at.frame();
    return {{q[0], q[1], q[2]}, {v[0], v[1], v[2]},
            {a[0], a[1], a[2]}, {world(turn.e0), world(turn.e1), world(turn.e2)},
            world(at.w(rate)),  world(at.w(second) + at.w_rate(rate))};
  }
  /// Writes the generalised force r of a force and a moment at the centre.
  template <class T>
  void project(const T* q, const Vec3<T>& force, const Vec3<T>& moment, T* r) const {
    store3(force, r);
    store3(chart(q).w_transposed(in_reference(moment)), r + 3);
  }
  /// Writes r = M a - f, without the forces of strands.
  template <class T>
  void equations(const T* q, const T* v, const T* a, T* r) const {
    const RotationChart<T> at = chart(q);
    const Vec3<T> rate(v[3], v[4], v[5]), second(a[3], a[4], a[5]);
    // In the components of the body.
    const Vec3<T> omega = at.w_transposed(rate),
                  alpha = at.w_transposed(second) + at.w_transposed_rate(rate);
    const Vec3<T> moment = momentum(alpha) + cross(omega, momentum(omega));
    store3(T(body.mass) * (Vec3<T>(a[0], a[1], a[2]) - Vec3<T>(gravity)), r);
    // W^T exp([phi]x) = W.
    store3(at.w(moment), r + 3);
  }
};

}  // namespace tress::models
