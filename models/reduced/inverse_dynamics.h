#pragma once

#include <cmath>

#include "models/effects/effect.h"
#include "models/reduced/kinematics.h"

namespace tress {

/// Force and moment about a frame's origin, in its components.
struct Wrench {
  Vec force, moment;
};

/// The residual of a reduced-coordinate tree by the recursive Newton-Euler scheme: motion
/// from the root to the tips (Kinematics), d'Alembert forces m p'' - f at the quadrature
/// points (gravity as an acceleration of the root [Luh, Walker, Paul 1980]), wrenches
/// from the tips to the root. O(N).
template <class Kernel, int dofs>
class InverseDynamics {
 public:
  InverseDynamics(Kinematics<Kernel, dofs>& kinematics, const Effects& effects)
      : kinematics_(kinematics), needs_(needs(effects)) {
    Vec uniform;
    for (const auto& effect : effects) {
      if (const auto acceleration = effect->uniform_acceleration()) {
        uniform = uniform + *acceleration;
      } else {
        loading_.push_back(effect.get());
      }
    }
    kinematics.fall(uniform);
    const std::size_t blocks = kinematics.blocks().size();
    count_ = Pack::lanes * blocks;
    load_.resize(3 * count_);
    if (!effects.empty()) {
      for (const PointBlock& block : kinematics.blocks()) {
        for (int lane = 0; lane < Pack::lanes; ++lane) {
          mass_.push_back(block.mass[lane]);
          length_.push_back(block.length[lane]);
        }
      }
    }
    if (needs_.position) x_.resize(3 * count_);
    if (needs_.velocity) v_.resize(3 * count_);
    if (needs_.tangent) tangent_.resize(3 * count_);
    force_.resize(blocks);
    at_tip_.resize(kinematics.segments().size());
  }

  void residual(double t, In q, In v, In a, Out r) {
    kinematics_.move(t, q, v, a);
    if (!loading_.empty()) {
      const Points p = points(needs_);
      std::fill(load_.begin(), load_.end(), 0.0);
      for (const Effect* effect : loading_) effect->add_load(t, p, load_);
    }
    for (Wrench& wrench : at_tip_) wrench = {};
    at_root_ = {};
    for (std::size_t i = at_tip_.size(); i-- > 0;) segment(i, q, v, r);
    if (kinematics_.free()) {
      at_root_.moment =
          at_root_.moment + rotor_moment(kinematics_.root_rotor(), kinematics_.root());
      kinematics_.free_root().residual(at_root_.force, at_root_.moment, r.last(6));
    }
  }

  /// The points that effects act on, at the motion that Kinematics holds; only what is
  /// asked for is computed.
  Points points(Needs wanted) {
    if (wanted.position) x_.resize(3 * count_);
    if (wanted.velocity) v_.resize(3 * count_);
    if (wanted.position || wanted.velocity || wanted.tangent) {
      const auto& segments = kinematics_.segments();
      for (std::size_t i = 0; i < segments.size(); ++i) {
        for (std::size_t b = segments[i].first_block; b < segments[i].last_block; ++b) {
          place(i, b, wanted);
        }
      }
    }
    return {.count = static_cast<int>(count_),
            .x = wanted.position ? In(x_) : In{},
            .v = v_,
            .tangent = tangent_,
            .mass = mass_,
            .length = length_};
  }

  // Of the last residual(): the force on each point's inertia in the components of the
  // segment's start, the loads alone in the same, and what hangs on each tip.
  const Vec3<Pack>& load(std::size_t block) const { return force_[block].load; }
  const Vec3<Pack>& force(std::size_t block) const { return force_[block].total; }
  const Wrench& at_tip(std::size_t i) const { return at_tip_[i]; }
  const Wrench& at_root() const { return at_root_; }
  const Needs& effect_needs() const { return needs_; }

 private:
  struct Force {
    Vec3<Pack> total, load;
  };

  /// I d/dt((omega . t) t), t = e0 of the frame.
  static Vec rotor_moment(double inertia, const FrameMotion& m) {
    const Vec& w = m.omega;
    return inertia * Vec{m.alpha.x, w.x * w.z, -1.0 * (w.x * w.y)};
  }

  void place(std::size_t i, std::size_t b, Needs wanted) {
    const auto& block = kinematics_.block_geometry(b);
    const auto scatter = [b](const Vec3<Pack>& x, std::vector<double>& to) {
      for (int lane = 0; lane < Pack::lanes; ++lane) {
        store3(Vec{x.x[lane], x.y[lane], x.z[lane]},
               &to[3 * (Pack::lanes * b + static_cast<std::size_t>(lane))]);
      }
    };
    if (wanted.position) {
      scatter(Vec3<Pack>(kinematics_.start(i).x) + kinematics_.world(i, block.position),
              x_);
    }
    if (wanted.velocity) {
      scatter(kinematics_.world(i, kinematics_.velocity(i, b)), v_);
    }
    if (wanted.tangent) {
      const Vec3<Pack> along =
          kinematics_.geometry(i).kernel.rotated(block.at, Helix::tangent);
      scatter(kinematics_.world(i, along), tangent_);
    }
  }

  Vec3<Pack> gathered(std::size_t b) const {
    const double* p = &load_[3 * Pack::lanes * b];
    return {Pack(Pack::Vector{p[0], p[3], p[6], p[9]}),
            Pack(Pack::Vector{p[1], p[4], p[7], p[10]}),
            Pack(Pack::Vector{p[2], p[5], p[8], p[11]})};
  }

  void segment(std::size_t i, In q, In v, Out r) {
    const ReducedSegment& segment = kinematics_.segments()[i];
    const auto& g = kinematics_.geometry(i);
    const auto& m = kinematics_.motion(i);
    const FrameMotion& from = kinematics_.start(i);

    Wrench& tip = at_tip_[i];
    tip.moment = tip.moment + rotor_moment(segment.rotor, m.tip);
    const Vec force = g.rotation * tip.force, moment = g.rotation * tip.moment;

    Vec3<Pack> sum_force, sum_moment;
    std::array<Pack, dofs> sum_r{};
    const Frame& f = from.frame;
    const Vec3<Pack> e0(f.e0), e1(f.e1), e2(f.e2), omega(from.omega), alpha(from.alpha),
        a(from.a);
    for (std::size_t b = segment.first_block; b < segment.last_block; ++b) {
      const auto& block = kinematics_.block_geometry(b);
      const Vec3<Pack>& p = block.position;
      Force& at = force_[b];
      at.total = kinematics_.blocks()[b].mass *
                 (a + cross(alpha, p) + m.accelerating.at(block.at) +
                  cross(omega, cross(omega, p) + Pack(2) * m.moving.at(block.at)));
      if (!loading_.empty()) {
        const Vec3<Pack> world = gathered(b);
        at.load = {dot(e0, world), dot(e1, world), dot(e2, world)};
        at.total = at.total - at.load;
      }
      sum_force = sum_force + at.total;
      sum_moment = sum_moment + cross(p, at.total);
      for (int k = 0; k < dofs; ++k) sum_r[k] += dot(block.slope[k], at.total);
    }
    const Vec kappa = Kinematics<Kernel, dofs>::components(q, i);
    const Vec rate = Kinematics<Kernel, dofs>::components(v, i);
    for (int k = 0; k < dofs; ++k) {
      const Vec e = Kinematics<Kernel, dofs>::unit(k);
      r[dofs * i + static_cast<std::size_t>(k)] =
          sum(sum_r[k]) + dot(g.slope[k], force) + dot(g.turn[k], moment) +
          dot(e, segment.stiffness) * dot(e, kappa - segment.rest) +
          dot(e, segment.friction) * dot(e, rate);
    }
    Wrench start{Vec{sum(sum_force.x), sum(sum_force.y), sum(sum_force.z)} + force,
                 Vec{sum(sum_moment.x), sum(sum_moment.y), sum(sum_moment.z)} + moment +
                     cross(g.position, force)};
    if (segment.mounted) {
      start = {segment.mount * start.force, segment.mount * start.moment};
    }
    Wrench& parent =
        segment.parent < 0 ? at_root_ : at_tip_[static_cast<std::size_t>(segment.parent)];
    parent = {parent.force + start.force, parent.moment + start.moment};
  }

  Kinematics<Kernel, dofs>& kinematics_;
  std::vector<const Effect*> loading_;  // those that are not uniform
  Needs needs_;
  std::size_t count_ = 0;
  std::vector<double> x_, v_, tangent_, mass_, length_, load_;
  std::vector<Force> force_;
  std::vector<Wrench> at_tip_;
  Wrench at_root_;
};

}  // namespace tress
