#pragma once

#include "math/frame.h"

namespace tress {

/// A quaternion w + v; with norm 1 it represents a rotation, the same for q and -q.
template <class T>
struct QuaternionOf {
  T w{1};       // scalar part
  Vec3<T> v{};  // vector part

  friend QuaternionOf operator*(const QuaternionOf& p, const QuaternionOf& q) {
    return {p.w * q.w - dot(p.v, q.v), p.w * q.v + q.w * p.v + cross(p.v, q.v)};
  }
  friend QuaternionOf operator*(const T& s, const QuaternionOf& q) {
    return {s * q.w, s * q.v};
  }
  /// Returns the scalar product of four numbers.
  friend T dot(const QuaternionOf& p, const QuaternionOf& q) {
    return p.w * q.w + dot(p.v, q.v);
  }
};

/// Quaternion in double precision.
using Quaternion = QuaternionOf<double>;

/// One of the two quaternions of a frame, of norm 1 to rounding.
Quaternion quaternion_of(const Frame& frame);
/// q or -q, whichever is nearer to p.
inline Quaternion nearer(const Quaternion& p, const Quaternion& q) {
  return dot(p, q) < 0 ? -1.0 * q : q;
}
/// q' for a frame rotating with omega (rad/s, world components): omega q/2.
template <class T>
QuaternionOf<T> rate_of(const QuaternionOf<T>& q, const Vec3<T>& omega) {
  return T(0.5) * (QuaternionOf<T>{T(0), omega} * q);
}

/// First axis of the frame times |q|^2: a quadratic form of q.
template <class T>
Vec3<T> first_axis(const QuaternionOf<T>& q) {
  const auto& [w, v] = q;
  const T two(2);
  return {w * w + v.x * v.x - v.y * v.y - v.z * v.z, two * (v.x * v.y + w * v.z),
          two * (v.x * v.z - w * v.y)};
}

/// All axes of the frame times |q|^2.
template <class T>
FrameOf<T> axes(const QuaternionOf<T>& q) {
  const auto& [w, v] = q;
  const T two(2), ww = w * w, xx = v.x * v.x, yy = v.y * v.y, zz = v.z * v.z;
  return {first_axis(q),
          {two * (v.x * v.y - w * v.z), ww - xx + yy - zz, two * (v.y * v.z + w * v.x)},
          {two * (v.x * v.z + w * v.y), two * (v.y * v.z - w * v.x), ww - xx - yy + zz}};
}

/// 2 vec(conj(p) q): has norm 2 |p| |q| sin(angle/2) and lies along the axis of the
/// rotation from p to q, in components of either frame. Bilinear, changes sign with p or
/// q.
template <class T>
Vec3<T> turn_between(const QuaternionOf<T>& p, const QuaternionOf<T>& q) {
  return T(2) * (p.w * q.v - q.w * p.v - cross(p.v, q.v));
}

/// Reads w and v from four numbers.
template <class T>
QuaternionOf<T> load_quaternion(const T* p) {
  return {p[0], load3(p + 1)};
}

/// Writes w and v as four numbers.
template <class T>
void store_quaternion(const QuaternionOf<T>& q, T* p) {
  p[0] = q.w;
  store3(q.v, p + 1);
}

/// The k-th of the four basis quaternions.
template <class T = double>
QuaternionOf<T> unit_quaternion(int k) {
  T q[4] = {T(0), T(0), T(0), T(0)};
  q[k] = T(1);
  return load_quaternion(q);
}

/// d first_axis/dq.
template <class T>
void axis_gradient(const QuaternionOf<T>& q, T (&g)[3][4]) {
  const auto& [w, v] = T(2) * q;
  const T rows[3][4] = {{w, v.x, -v.y, -v.z}, {v.z, v.y, v.x, w}, {-v.y, v.z, -w, v.x}};
  for (int k = 0; k < 3; ++k) {
    for (int l = 0; l < 4; ++l) g[k][l] = rows[k][l];
  }
}

/// d turn_between(p, q)/dq; the derivative by p is turn_slope(-q).
template <class T>
void turn_slope(const QuaternionOf<T>& p, T (&g)[3][4]) {
  const auto& [w, v] = T(2) * p;
  const T rows[3][4] = {{-v.x, w, v.z, -v.y}, {-v.y, -v.z, w, v.x}, {-v.z, v.y, -v.x, w}};
  for (int k = 0; k < 3; ++k) {
    for (int l = 0; l < 4; ++l) g[k][l] = rows[k][l];
  }
}

}  // namespace tress
