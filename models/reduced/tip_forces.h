#pragma once

#include <span>

#include "models/reduced/kinematics.h"
#include "models/reduced/tree_tangent.h"

namespace tress::models {

/// World forces on tips of segments, as unknowns and wrenches feel them. Point 0 is the
/// root, point i + 1 the tip of segment i.
template <class Kernel, int dofs>
class TipForces {
 public:
  using S = Space<dofs>;
  using Wrenches = Eigen::Matrix<double, S::size, 3>;

  /// At q, whose shape the kinematics has or takes.
  TipForces(Kinematics<Kernel, dofs>& kinematics, double t, In q)
      : kinematics_(kinematics), frames_(kinematics.frames(t, q)) {}

  /// The wrenches of unit forces on a point along the axes of the world, in its frame.
  Wrenches units(int point) const {
    const Frame& f = frames_[static_cast<std::size_t>(point)];
    const double* const axes[3] = {&f.e0.x, &f.e1.x, &f.e2.x};
    Wrenches all = Wrenches::Zero();
    for (int i = 0; i < S::translations; ++i) {
      for (int d = 0; d < 3; ++d) all(i, d) = axes[S::translation[i]][d];
    }
    return all;
  }

  /// b += J^T f of forces (3 numbers each, N) on ascending points of a chain.
  void pull_back(std::span<const int> points, In forces, InOut b) const {
    // In the components of the tip, or start, that the sweep is at.
    Vec force, moment;
    const auto take = [&](int point) {
      if (points.empty() || points.back() != point) return;
      points = points.first(points.size() - 1);
      force = force + frames_[static_cast<std::size_t>(point)].back(
                          load3(&forces[3 * points.size()]));
    };
    for (int i = kinematics_.count() - 1; i >= 0; --i) {
      take(i + 1);
      const auto segment = static_cast<std::size_t>(i);
      const auto& g = kinematics_.geometry(segment);
      force = g.rotation * force;
      moment = g.rotation * moment;
      for (std::size_t k = 0; k < dofs; ++k) {
        b[dofs * segment + k] += dot(g.slope[k], force) + dot(g.turn[k], moment);
      }
      moment = moment + cross(g.position, force);
      const auto& of = kinematics_.segments()[segment];
      if (!of.mounted) continue;
      force = of.mount * force;
      moment = of.mount * moment;
    }
    take(0);
    if (!kinematics_.free()) return;
    std::array<double, 6> at_root;
    kinematics_.free_root().residual(force, moment, at_root);
    for (std::size_t k = 0; k < 6; ++k) b[b.size() - 6 + k] += at_root[k];
  }

 private:
  Kinematics<Kernel, dofs>& kinematics_;
  const std::vector<Frame>& frames_;
};

}  // namespace tress::models
