#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "models/coupling/coupling.h"
#include "models/reduced/mass_tangent.h"

namespace tress::models {

/// Contribution of a contact to an exact Jacobian (ExactTangent), at the motion held by
/// Kinematics. It consists of the derivatives of the positions and velocities of the
/// contact's points by their segments' states and unknowns, and of the effect of a force
/// on these. O(1) per contact.
template <class Kernel, int modes>
class ContactTangent {
  using Shape = ExactShapeOf<Kernel, modes>;

 public:
  /// Reads the motion of `kinematics`, which must outlive it.
  explicit ContactTangent(const Kinematics<Kernel, modes>& kinematics)
      : kinematics_(kinematics) {}

  /// Returns the contribution of a contact to the Jacobian of weights w.
  TreeCoupling<Shape> of(const Coupling& contact, Weights w) const {
    TreeCoupling<Shape> all;
    for (std::size_t a = 0; a < all.ends.size(); ++a) {
      all.ends[a] = end(contact.ends[a], w);
    }
    return all;
  }

 private:
  using K = Kinematics<Kernel, modes>;
  using Frames = SegmentFrames<Shape>;
  using End = typename TreeCoupling<Shape>::End;
  static constexpr int dofs = Shape::dofs, size = Space<modes>::size,
                       rank = TreeCoupling<Shape>::rank;

  std::size_t segment_of(std::size_t block) const {
    const auto& all = kinematics_.segments();
    const auto found = std::ranges::upper_bound(all, block, {}, &K::Segment::last_block);
    return static_cast<std::size_t>(found - all.begin());
  }

  End end(const Coupling::End& at, Weights w) const {
    const std::size_t b = at.point / Pack::lanes, i = segment_of(b);
    const auto lane = [at](const Vec3<Pack>& x) {
      const int k = static_cast<int>(at.point % Pack::lanes);
      return Vec{x.x[k], x.y[k], x.z[k]};
    };
    const FrameMotion& from = kinematics_.start(i);
    const auto& m = kinematics_.motion(i);
    const auto& block = kinematics_.block_geometry(b);
    const Vec p = lane(block.position);
    const Vec u = from.v + cross(from.omega, p) + lane(m.moving.at(block.at));
    std::array<Vec, dofs> slope, turned;  // derivatives of position and u by an unknown
    for (std::size_t k = 0; k < dofs; ++k) {
      const auto e = K::unit(static_cast<int>(k));
      slope[k] = lane(block.slope[k]);
      turned[k] = cross(from.omega, slope[k]) +
                  lane(kinematics_.geometry(i).kernel.second(m.rate, e).at(block.at));
    }

    End end;
    end.segment = static_cast<int>(i);
    end.by.setZero();
    for (int r = 0; r < rank; ++r) {
      const auto row = static_cast<std::size_t>(r);
      const Vec by_x = from.frame.back(at.by_place[row]);
      const Vec by_v = from.frame.back(at.by_velocity[row]);
      Vec by_start = by_x;
      if constexpr (modes == 1) {  // as in ExactTangent
        by_start = by_start + by_v.y * Vec{from.omega.z, 0, -from.omega.x};
      }
      const Vec force = from.frame.back(-1.0 * at.onto[row]);
      Frames::put(by_start, cross(p, by_start) + cross(u, by_v),
                  part<1, size>(end.by, r, 0).transpose());
      Frames::put(by_v, cross(p, by_v), part<1, size>(end.by, r, size).transpose());
      Frames::put(force, cross(p, force), column_of(end.onto, r));
      for (std::size_t k = 0; k < dofs; ++k) {
        const auto unknown = static_cast<int>(k);
        end.by(r, 3 * size + unknown) =
            w.pos * (dot(by_x, slope[k]) + dot(by_v, turned[k])) +
            w.vel * dot(by_v, slope[k]);
        end.onto(size + unknown, r) = dot(slope[k], force);
      }
    }
    if constexpr (modes > 1) {
      const auto& segment = kinematics_.segments()[i];
      if (segment.mounted) {
        Frames::mount_states(segment.mount, end.by);
        Frames::mount_wrench(segment.mount, end.onto);
      }
    }
    return end;
  }

  const Kinematics<Kernel, modes>& kinematics_;
};

/// World forces on tips of segments, as unknowns and wrenches feel them. Point 0 is the
/// root, point i + 1 the tip of segment i. Forces and unknowns are packs if the kernel's
/// scalar is one.
template <class Kernel, int modes>
class TipForces {
  using S = Space<modes>;
  using K = Kinematics<Kernel, modes>;
  using Real = typename K::Real;
  using In = typename K::In;
  using Vec = typename K::Vec;
  using Frame = typename K::Frame;
  using Wrenches = Eigen::Matrix<Real, S::size, 3>;
  static constexpr int dofs = K::dofs;

 public:
  /// Takes the frames at t and q, and the shape at q from `kinematics`, which must
  /// outlive it.
  TipForces(K& kinematics, double t, In q)
      : kinematics_(kinematics), frames_(kinematics.frames(t, q)) {}

  /// Returns the wrenches of unit forces on a point along the axes of the world as
  /// columns, in the frame of the point.
  Wrenches units(int point) const {
    const Frame& f = frames_[static_cast<std::size_t>(point)];
    const Vec* const axes[3] = {&f.e0, &f.e1, &f.e2};
    Wrenches all = Wrenches::Zero();
    for (int i = 0; i < S::translations; ++i) {
      const Vec& axis = *axes[S::translation[i]];
      all(i, 0) = axis.x;
      all(i, 1) = axis.y;
      all(i, 2) = axis.z;
    }
    return all;
  }

  /// Adds b += J^T f of forces (3 numbers each, N) on ascending points of a chain.
  void pull_back(std::span<const int> points, In forces, std::span<Real> b) const {
    sweep(
        [&](int point, Vec& force, Vec&) {
          if (points.empty() || points.back() != point) return;
          points = points.first(points.size() - 1);
          const Real* const f = &forces[3 * points.size()];
          force = force +
                  frames_[static_cast<std::size_t>(point)].back(Vec{f[0], f[1], f[2]});
        },
        b);
  }
  /// Adds b += J^T m of a moment (N m) on the section at a point of a chain, J = d
  /// omega/dv.
  void pull_back_moment(int at, const Vec& of, std::span<Real> b) const {
    sweep(
        [&](int point, Vec&, Vec& moment) {
          if (point == at) moment = frames_[static_cast<std::size_t>(point)].back(of);
        },
        b);
  }

 private:
  /// take(point, force, moment) adds what acts at a point, from the last one on.
  template <class Take>
  void sweep(Take take_at, std::span<Real> b) const {
    // In the components of the tip, or start, that the sweep is at.
    Vec force, moment;
    const auto take = [&](int point) { take_at(point, force, moment); };
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

  K& kinematics_;
  const std::vector<Frame>& frames_;
};

}  // namespace tress::models
