#pragma once

#include "models/reduced/definite_block.h"
#include "models/reduced/inverse_dynamics.h"
#include "models/reduced/mass_tangent.h"

namespace tress::models {

/// A tangent for the segments of Kinematics, with transfer, local and tip set to zero.
template <class Shape, class K>
TreeTangent<Shape> empty_tangent(const K& kinematics) {
  TreeTangent<Shape> tangent;
  for (const auto& segment : kinematics.segments()) {
    tangent.parent.push_back(segment.parent);
  }
  tangent.segments.resize(tangent.parent.size());
  for (auto& segment : tangent.segments) {
    segment.transfer.setZero();
    segment.local.setZero();
    segment.tip.setZero();
  }
  tangent.free_root = kinematics.free();
  return tangent;
}

/// Mass, friction and elastic stiffness of all segments, w.acc M + w.vel C + w.pos K,
/// plus the derivatives of effects by the position and velocity of each point. The latter
/// are made symmetric and semidefinite so that the sum stays definite. A repulsion is
/// stiff along its gap but has the negative stiffness force/gap across it, more than mass
/// and elasticity can balance. The dependence of loads on the strand's tangent is
/// omitted.
template <class Kernel, int modes>
class StiffTangent {
  using K = Kinematics<Kernel, modes>;
  using In = typename K::In;
  using Shape = MassShapeOf<Kernel, modes>;

 public:
  /// Takes kinematics and dynamics, which at() moves; they must outlive it.
  StiffTangent(K& kinematics, InverseDynamics<Kernel, modes>& dynamics)
      : kinematics_(kinematics),
        dynamics_(dynamics),
        tangent_(empty_tangent<Shape>(kinematics)) {
    if (!dynamics.effect_needs().derivatives) return;
    zero_.resize(static_cast<std::size_t>(kinematics.unknowns()));
    of_effects_.resize(9 * kinematics.points());
  }

  /// Returns the matrix of weights w at (t, q, v), valid until the next call.
  const TreeTangent<Shape>& at(double t, In q, In v, Weights w) {
    if (of_effects_.empty() || (w.vel == 0 && w.pos == 0)) {
      kinematics_.shape(q);
      return here(w, {});
    }
    kinematics_.move(t, q, v, zero_);
    dynamics_.place(dynamics_.effect_needs());
    dynamics_.derivatives(t, -w.pos, -w.vel, of_effects_);
    make_semidefinite(of_effects_);
    return here(w, of_effects_);
  }
  /// Returns the matrix without effects, at the shape of Kinematics.
  const TreeTangent<Shape>& here(Weights w) { return here(w, {}); }

  /// Returns the matrix of the last call.
  const TreeTangent<Shape>& last() const { return tangent_; }

 private:
  const TreeTangent<Shape>& here(Weights w, tress::In of_effects) {
    for (std::size_t i = 0; i < tangent_.segments.size(); ++i) {
      mass_tangent(kinematics_, i, w, tangent_.segments[i], of_effects);
    }
    if (tangent_.free_root) mass_root_tangent(kinematics_, w, tangent_.root);
    return tangent_;
  }

  K& kinematics_;
  InverseDynamics<Kernel, modes>& dynamics_;
  TreeTangent<Shape> tangent_;
  std::vector<typename K::Real> zero_;
  std::vector<double> of_effects_;  // 9 per point
};

}  // namespace tress::models
