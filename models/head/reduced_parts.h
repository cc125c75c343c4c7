#pragma once

#include "math/matrix3.h"
#include "math/wrench.h"
#include "models/strand/element_points.h"

/// Data that the sweeps of models/head/reduced_kernel.h pass from element to element.
namespace tress::models {

/// Properties common to all elements of a strand, in consistent units.
template <class T>
struct ReducedMaterial {
  T length;           // of an element
  T density;          // mass per length
  T drag;             // force per length and velocity: nu + c density (LinearDrag)
  Vec3<T> stiffness;  // moment per unknown of an element
  T friction;         // moment per rate of an unknown
  T rotor;            // inertia of an element about its tangent: length rho (I1 + I2)
};

/// Motion of a frame in its own components, such as that of a clamped root, relative to
/// free fall.
template <class T>
struct ReducedMotion {
  Vec3<T> v, omega;  // velocity, angular velocity
  Vec3<T> a, alpha;  // acceleration minus g, angular acceleration
};

/// Articulated inertia at a frame: force = ll a + la alpha, moment = la^T a + aa alpha.
template <class T>
struct ArticulatedInertia {
  Symmetric3<T> ll, aa;  // force by a, and moment by alpha
  Matrix3<T> la;         // force by alpha
};

/// Factors of the acceleration in S: of a unit of length, and of a rotor.
template <class T>
struct ReducedInertia {
  T of_length, acc;  // w.acc density + w.vel drag, and w.acc
};

/// Inertia that hangs on the tip of an element, in the components of the element's start,
/// and its coupling to the element's motion.
template <class T>
struct HangingOnTip {
  Symmetric3<T> ll, aa;       // of the tip
  Matrix3<T> la, al;          // of the tip
  Matrix3<T> f_turn, m_turn;  // wrench of a turn of the start: the tip moves by -[P]x

  /// Turns the inertia of a tip at `position` into the components of the start.
  HangingOnTip(const Matrix3<T>& rotation, const Vec3<T>& position,
               const ArticulatedInertia<T>& hanging)
      : ll(congruent(rotation, hanging.ll)),
        aa(congruent(rotation, hanging.aa)),
        la(rotation * hanging.la * rotation.transposed()),
        al(la.transposed()),
        f_turn(la - times_cross(full(ll), position)),
        m_turn(full(aa) - times_cross(al, position)) {}
  /// Returns the force of a change of unknowns that moves the tip by `slope` and turns it
  /// by `turn`.
  Matrix3<T> force(const Matrix3<T>& slope, const Matrix3<T>& turn) const {
    return ll * slope + la * turn;
  }
  /// Returns the moment about the tip of the same change.
  Matrix3<T> moment(const Matrix3<T>& slope, const Matrix3<T>& turn) const {
    return al * slope + aa * turn;
  }
};

/// Inertia of mass whose moments about a frame are `first` and `second`, added to `to`.
template <class T>
void add_mass(const T& mass, const Vec3<T>& first, const Symmetric3<T>& second,
              ArticulatedInertia<T>& to) {
  to.ll.xx += mass;
  to.ll.yy += mass;
  to.ll.zz += mass;
  to.la = to.la - cross_matrix(first);
  to.aa = to.aa - second;
  const T trace = second.xx + second.yy + second.zz;
  to.aa.xx += trace;
  to.aa.yy += trace;
  to.aa.zz += trace;
}

/// Inertia of an element with all that hangs on it, in its axes, before its unknowns are
/// eliminated.
template <class T>
struct UneliminatedInertia {
  ArticulatedInertia<T> sum;       // inertia at fixed unknowns
  Symmetric3<T> own;               // H_kk
  Matrix3<T> of_force, of_moment;  // H_k(translation), H_k(rotation), rows k
};

/// Position and velocity of a point of an element, seen from the element's start.
template <class T>
struct SeenPoint {
  Vec3<T> position, velocity;  // in the axes of the start
};
/// Position, velocity and turn of an element's tip, seen from the element's start.
template <class T>
struct SeenTip {
  Vec3<T> position, velocity;  // in the axes of the start
  Matrix3<T> rotation;         // from the components of the tip to those of the start
  Vec3<T> turning;             // angular velocity, in the axes of the start
};

/// Returns the inverse of a matrix of an element's three unknowns; without twist, of the
/// lower right block.
template <class T>
Symmetric3<T> inverse_of_modes(const Symmetric3<T>& h, bool twist) {
  if (twist) return inverse(h);
  const T o(0), by = T(1) / (h.yy * h.zz - h.yz * h.yz);
  return {o, h.zz * by, h.yy * by, o, o, -h.yz * by};
}

/// A quadrature point of an element: its number, and its arc length.
template <class T>
struct PointPlace {
  int number;  // from 0
  T arc;       // from the element's start
};

/// Returns the moment I d/dt((omega . t) t) that turns the rotor of an element, t its
/// tangent.
template <class T>
Vec3<T> rotor_moment(const T& inertia, const Vec3<T>& w, const Vec3<T>& alpha) {
  return inertia * Vec3<T>{alpha.x, w.x * w.z, -(w.x * w.y)};
}

}  // namespace tress::models
