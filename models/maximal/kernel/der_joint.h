#pragma once

#include "math/scalar_math.h"
#include "models/maximal/kernel/algebra.h"

namespace tress::models {

/// The joint's strains from turn(a, b) = (axis a before) . (axis b of the edge), and
/// their gradients by the rotation of the edge in its components. The formulas are those
/// of models/maximal/joint_strain.h with all products written out.
template <class T>
struct DerJoint {
  /// Vector of these scalars.
  using Vec = Vec3<T>;
  /// Matrix of these scalars.
  using Matrix = Matrix3<T>;
  /// Symmetric matrix of these scalars.
  using Symmetric = Symmetric3<T>;

  /// Evaluates the strains for the rotation between the edges.
  explicit DerJoint(const Matrix& r)
      : by(T(1) / (T(1) + r.row[0].x)),
        value{arc_tangent(r.row[2].y - r.row[1].z, r.row[1].y + r.row[2].z),
              by * (r.row[0].z - r.row[2].x), by * (r.row[1].x - r.row[0].y)},
        k{T(0), by * r.row[0].z, -(by * r.row[0].y)},
        twist{T(1), by * r.row[0].y, by * r.row[0].z},
        curvature1{-(by * r.row[0].y), by * (r.row[0].x + r.row[2].z) + value.y * k.y,
                   -(by * r.row[2].y) + value.y * k.z},
        curvature2{-(by * r.row[0].z), -(by * r.row[1].z) + value.z * k.y,
                   by * (r.row[0].x + r.row[1].y) + value.z * k.z} {}
  T by;                                         // 1/(1 + cosine of the angle)
  Vec value, k, twist, curvature1, curvature2;  // strains; half the binormal; gradients

  /// stiffness and damping, times the slopes of the strains.
  Symmetric stiff(const Vec& weight) const {
    Symmetric all;
    add_square(all, weight.x, twist);
    add_square(all, weight.y, curvature1);
    add_square(all, weight.z, curvature2);
    return all;
  }

  /// A quadratic form of the rotations u of the edge before and w of the edge, both in
  /// its components: u . N u + w . N w + 2 u . U w.
  struct Form {
    Symmetric alike;  // N
    Matrix across;    // U
  };
  /// JointStrain::second() times these stresses.
  Form second(const Matrix& r, const Vec& stress) const {
    const T s2 = by * stress.z, s1 = -(by * stress.y);
    const T s = s2 * value.z - s1 * value.y;
    const Vec minus = s2 * r.row[1] + s1 * r.row[2], plus{s, s2, s1};
    const Vec t_minus = r.row[0], t_plus{T(1), T(0), T(0)};
    const Vec g =
        T(2) * stress.y * curvature1 + T(2) * stress.z * curvature2 + stress.x * twist;
    Symmetric relative{-s, -s, -s};
    add_product(relative, T(1), g, k);
    const T half = T(0.5) * stress.x;
    Form form{relative, half * cross_matrix(twist) - full(relative)};
    form.across.row[0] = form.across.row[0] + plus.x * t_minus - minus;
    form.across.row[1] = form.across.row[1] + plus.y * t_minus;
    form.across.row[2] = form.across.row[2] + plus.z * t_minus;
    add_product(form.alike, T(1), minus, t_plus);
    add_product(form.alike, T(-1), plus, t_minus);
    return form;
  }
};

/// Second derivative of the rotation of an edge by its rotation and lengthening, times a
/// moment on it (components of its frame): models/maximal/rod_edge.h's
/// EdgeTurn::add_second() in these coordinates. With p = (t + a)/(1 + a . t) and b = a
/// less its part along t,
///
///     (omega . (t x m)) (omega . t) + m_t/(1 + a . t)^2 (omega . b) (omega . (t x a))
///       + 2 sigma/L omega . (m_t b/(1 + a . t) - m + m_t t).
template <class T>
struct DerEdgeForm {
  Symmetric3<T> omega;  // part of omega and omega
  Vec3<T> sigma;        // of sigma and omega

  /// Evaluates the form.
  DerEdgeForm(const Vec3<T>& p, const T& inverse_length, const Vec3<T>& moment) {
    // b beside = (0, p_y, p_z).
    const Vec3<T> b{T(0), p.y, p.z};
    omega.xy = -(T(0.5) * moment.z);
    omega.xz = T(0.5) * moment.y;
    add_product(omega, moment.x, b, {T(0), -p.z, p.y});
    sigma = inverse_length * (moment.x * b - Vec3<T>{T(0), moment.y, moment.z});
  }
};

}  // namespace tress::models
