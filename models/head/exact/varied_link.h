#pragma once

#include "models/head/chain_strand.h"
#include "models/head/exact/varied_element.h"

namespace tress::models {

/// Rigid link behind a ball joint (models/head/chain_strand.h), seen from the joint in
/// the axes of the link before. P = s t and t = E e0. With W_j the columns of W,
/// dP/dtheta_j = s W_j x t, so sums over the link are closed.
template <class T>
class VariedElement<ChainKind<T>> {
 public:
  /// Vector of these scalars.
  using Vec = Vec3<T>;
  /// Matrix of these scalars.
  using Matrix = Matrix3<T>;
  /// Data of an element that steps do not change.
  using Material = ReducedMaterial<T>;

  /// Prepares a link at a state.
  VariedElement(const Material& m, Weights w, const Vec& q, const Vec& rate,
                const Vec& acceleration)
      : m_(m) {
    const Vec along = T(w.pos) * q;
    const VariedVec<T> of_rate = varied_alike(rate, T(w.vel));
    const LaneFunctions<T> functions(q, T(1));
    const auto joint =
        HelixElement<Varied<T>>(varied_alike(q, T(w.pos)), of_rate)
            .turn(Varied<T>(T(1)), varied_functions(functions.at(T(1)), along),
                  varied(functions.x2(), T(2) * along));
    tip_.rotation = value_of(joint.rotation);
    tip_.turn = joint.turn;
    tip_.turning = joint.velocity;
    tip_.spinning = joint.bias + joint.turn * varied_alike(acceleration, T(w.acc));
    // dt = W dtheta x t.
    const Vec t = tip_.rotation.column(0);
    const Matrix turn = T(w.pos) * value_of(joint.turn);
    along_ = with_parts(t, cross(turn.column(0), t), cross(turn.column(1), t),
                        cross(turn.column(2), t));
    moving_ = cross(tip_.turning, along_);
    bent_ = cross(tip_.spinning, along_) + cross(tip_.turning, moving_);
    // Rows of W^T [t]x^T are W_j x t.
    const Matrix3<Varied<T>> back = joint.turn.transposed();
    slope_ = {{cross(back.row[0], along_), cross(back.row[1], along_),
               cross(back.row[2], along_)}};
    tip_.position = m.length * along_;
    tip_.velocity = m.length * moving_;
    tip_.acceleration = m.length * bent_;
    tip_.slope = {
        {m.length * slope_.row[0], m.length * slope_.row[1], m.length * slope_.row[2]}};
    tip_.slope = tip_.slope.transposed();
  }

  /// Returns the motion of the tip.
  const VariedTip<T>& tip() const { return tip_; }

  /// Returns the motion of the point at an arc length.
  VariedPoint<T> point(const T& arc) const {
    const Matrix3<Varied<T>> rows{
        {arc * slope_.row[0], arc * slope_.row[1], arc * slope_.row[2]}};
    return {arc * along_, arc * moving_, rows.transposed()};
  }
  /// Transforms from the components of the element's axes to those of its start.
  Vec in_start(const Vec& x) const { return tip_.rotation * x; }
  /// Transforms a matrix from the components of the link's axes to those of its start.
  Matrix in_start(const Matrix& m) const {
    return tip_.rotation * m * tip_.rotation.transposed();
  }

  /// `from`: motion of its start.
  template <class Kernel>
  VariedWrench<T> inertial(const Kernel& /*kernel*/, const ReducedMotion<T>& from,
                           ElementSums<T>& sums) const {
    const T& l = m_.length;
    const T first = T(0.5) * l * l, second = T(2.0 / 3) * first * l;
    // At the distance s the velocity is v + s u, the acceleration a + s b.
    const VariedVec<T> arm = cross(from.omega, along_);
    const VariedVec<T> u = arm + moving_;
    const VariedVec<T> b =
        cross(from.alpha, along_) + bent_ + cross(from.omega, arm + T(2) * moving_);
    const Vec near = m_.density * from.a + m_.drag * from.v;
    const VariedVec<T> far = m_.density * b + m_.drag * u;
    VariedWrench<T> all;
    all.force = Vec(l * near) + first * far;
    const VariedVec<T> levered = cross(along_, Vec(first * near) + second * far);
    all.moment = levered;
    all.unknown = tip_.turn.back(levered);
    add_up(from.omega, first, second, sums);
    return all;
  }

 private:
  void add_up(const Vec& omega, const T& first, const T& second,
              ElementSums<T>& to) const {
    const Vec t = value_of(along_), moving = value_of(moving_);
    const Matrix slope = value_of(slope_);
    to.one = m_.length;
    to.first = first * t;
    const Vec s_t = second * t;
    to.second = {t.x * s_t.x, t.y * s_t.y, t.z * s_t.z,
                 t.x * s_t.y, t.x * s_t.z, t.y * s_t.z};
    to.momentum[0] = first * slope;
    to.moved = first * moving;
    to.moving = dyad(moving, s_t);
    const T along = dot(t, omega);
    for (int j = 0; j < 3; ++j) {
      const Vec& d = slope.row[j];
      to.spin[0].row[j] = cross(s_t, d);
      to.convective[0].row[j] =
          second * (along * d + dot(d, omega) * t + T(2) * cross(moving, d));
    }
  }

  const Material& m_;
  VariedTip<T> tip_;
  VariedVec<T> along_, moving_, bent_;
  Matrix3<Varied<T>> slope_;  // rows j: W_j x t
};

}  // namespace tress::models
