#pragma once

#include "math/lane_choice.h"
#include "math/matrix3.h"

namespace tress::models {

/// The load f of effects on a point, and B = -(w.pos df/dx + w.vel df/dv), symmetric and
/// semidefinite where it enters a tangent.
template <class T>
struct PointLoad {
  Vec3<T> force;        // load f
  Symmetric3<T> block;  // matrix B
};

/// Load on a point with separate derivatives of any symmetry: -df/dx at constant
/// velocity, and -df/du.
template <class T>
struct ExactLoad {
  Vec3<T> force;          // load f
  Matrix3<T> by_x, by_u;  // -df/dx and -df/du
};
/// Load on a point of an element, in some lanes.
template <class T, class Load>
struct LoadedPoint {
  Vec3<T> p;  // position from the start, in the element's axes
  Load load;  // load on the point
  T some;     // 1 in lanes with a load, 0 in others
};
/// Point with a load of separate derivatives.
template <class T>
using ExactPoint = LoadedPoint<T, ExactLoad<T>>;

using tress::where_less;  // of numbers, not hidden by those of matrices
/// Returns `yes` where x < y, else `no`, lane by lane.
template <class T>
Symmetric3<T> where_less(const T& x, const T& y, const Symmetric3<T>& yes,
                         const Symmetric3<T>& no) {
  const auto one = [&](const T& a, const T& b) { return tress::where_less(x, y, a, b); };
  return {one(yes.xx, no.xx), one(yes.yy, no.yy), one(yes.zz, no.zz),
          one(yes.xy, no.xy), one(yes.xz, no.xz), one(yes.yz, no.yz)};
}
/// Returns `yes` where x < y, else `no`, lane by lane.
template <class T>
Vec3<T> where_less(const T& x, const T& y, const Vec3<T>& yes, const Vec3<T>& no) {
  return {where_less(x, y, yes.x, no.x), where_less(x, y, yes.y, no.y),
          where_less(x, y, yes.z, no.z)};
}
/// Returns `yes` where x < y, else `no`, lane by lane.
template <class T>
Matrix3<T> where_less(const T& x, const T& y, const Matrix3<T>& yes,
                      const Matrix3<T>& no) {
  return {{where_less(x, y, yes.row[0], no.row[0]),
           where_less(x, y, yes.row[1], no.row[1]),
           where_less(x, y, yes.row[2], no.row[2])}};
}

/// Sums of loads over an element that moves as a rigid body, sum J^T f and sum J^T B J,
/// in the components of the element's axes. J = [1, -[P]x] is the motion of a point.
template <class T>
struct RigidLoadSums {
  T some{};               // 1 in lanes with a load, 0 in others
  Vec3<T> force, moment;  // sums of J^T f
  Symmetric3<T> ll, aa;   // diagonal blocks of the sum of J^T B J
  Matrix3<T> la;          // block of translations and rotations

  /// Adds the force f on a point at p, without the terms of the unknowns.
  void add_force(const Vec3<T>& p, const Vec3<T>& f) {
    force = force + f;
    moment = moment + cross(p, f);
  }
  /// Adds the matrix B of a point at p, without the terms of the unknowns.
  void add_block(const Vec3<T>& p, const Symmetric3<T>& block) {
    const Matrix3<T> turned = times_cross(full(block), p);
    ll = ll + block;
    la = la - turned;
    aa = aa - upper(cross_times(p, turned));
  }
  /// Adds `more` to `to` in lanes with a load; elsewhere not even the sign of a zero
  /// changes.
  template <class M>
  void add_to(M& to, const M& more) const {
    to = where_less(T(0), some, to + more, to);
  }
};

/// Sums of loads over an element of three unknowns. J = [1, -[P]x, d] is the motion of a
/// point, d_j = dP/dq_j.
template <class T>
struct LoadSums : RigidLoadSums<T> {
  Vec3<T> unknown;                 // sum of d^T f
  Symmetric3<T> inner;             // sum of d^T B d
  Matrix3<T> of_force, of_moment;  // rows j: sum B d_j, sum P x B d_j

  /// Adds the terms of the unknowns, which move the point by d, to add_force().
  void add_force_of_unknowns(const Matrix3<T>& d, const Vec3<T>& f) {
    unknown = unknown + d.back(f);
  }
  /// Adds the terms of the unknowns, which move the point by d, to add_block().
  void add_block_of_unknowns(const Vec3<T>& p, const Matrix3<T>& d,
                             const Symmetric3<T>& block) {
    const Matrix3<T> own = block * d;
    of_force = of_force + own.transposed();
    of_moment = of_moment + cross_times(p, own).transposed();
    inner = inner + upper(d.transposed(), own.transposed());
  }
};

}  // namespace tress::models
