#pragma once

#include <cmath>

#include "models/effects/effect.h"
#include "models/reduced/kinematics.h"

namespace tress::models {

/// Force and moment about a frame's origin, in its components.
template <class T>
struct WrenchOf {
  Vec3<T> force, moment;
};
using Wrench = WrenchOf<double>;

/// The residual of a reduced-coordinate tree by the recursive Newton-Euler scheme. Motion
/// goes from the root to the tips (Kinematics), d'Alembert forces m p'' - f act at the
/// quadrature points, and wrenches go from the tips to the root. Gravity is an
/// acceleration of the root [Luh, Walker, Paul 1980]. O(N). One strand, or one per lane.
template <class Kernel, int modes>
class InverseDynamics {
 public:
  using K = Kinematics<Kernel, modes>;
  using Real = typename K::Real;
  using In = std::span<const Real>;
  using Out = std::span<Real>;
  using Wrench = WrenchOf<Real>;
  static constexpr int dofs = K::dofs;

  /// Effects of each strand; further lanes have none.
  InverseDynamics(K& kinematics, std::vector<Effects> effects_of_strands)
      : kinematics_(kinematics),
        count_(kinematics.points()),
        effects_(std::move(effects_of_strands)),
        loading_(effects_.size()) {
    const std::vector<Effects>& effects = effects_;
    Vec3<Real> uniform;
    for (std::size_t strand = 0; strand < effects.size(); ++strand) {
      Vec3<double> sum;
      for (const auto& effect : effects[strand]) {
        if (const auto acceleration = effect->uniform_acceleration()) {
          sum = sum + *acceleration;
        } else {
          loading_[strand].push_back(effect.get());
          loaded_ = true;
        }
      }
      set_lane(uniform, static_cast<int>(strand), sum);
      needs_of_.push_back(needs(effects[strand]));
      needs_ = needs_ | needs_of_.back();
    }
    kinematics.fall(uniform);
    const std::size_t blocks = kinematics.blocks().size(), all = Pack::lanes * blocks;
    load_.resize(3 * all);
    mass_.resize(all);
    length_.resize(all);
    for (std::size_t b = 0; b < blocks; ++b) {
      for (int lane = 0; lane < Pack::lanes; ++lane) {
        const std::size_t at =
            K::first_point(b) + static_cast<std::size_t>(lane) * kinematics.point_step();
        mass_[at] = kinematics.blocks()[b].mass[lane];
        length_[at] = kinematics.blocks()[b].length[lane];
      }
    }
    if (needs_.position) x_.resize(3 * all);
    if (needs_.velocity) v_.resize(3 * all);
    if (needs_.tangent) tangent_.resize(3 * all);
    force_.resize(blocks);
    at_tip_.resize(kinematics.segments().size());
  }

  void residual(double t, In q, In v, In a, Out r) {
    kinematics_.move(t, q, v, a);
    if (loaded_) {
      place(needs_);
      std::fill(load_.begin(), load_.end(), 0.0);
      for (std::size_t strand = 0; strand < loading_.size(); ++strand) {
        const Points p = points(strand, needs_of_[strand]);
        const InOut load = InOut(load_).subspan(3 * strand * count_, 3 * count_);
        for (const Effect* effect : loading_[strand]) effect->add_load(t, p, load);
      }
    }
    for (Wrench& wrench : at_tip_) wrench = {};
    at_root_ = {};
    for (std::size_t i = at_tip_.size(); i-- > 0;) segment(i, q, v, r);
    if constexpr (lanes<Real> == 1) {
      if (!kinematics_.free()) return;
      at_root_.moment =
          at_root_.moment + rotor_moment(kinematics_.root_rotor(), kinematics_.root());
      kinematics_.free_root().residual(at_root_.force, at_root_.moment, r.last(6));
    }
  }

  /// Computes the wanted quantities of the points on which effects act, at the motion
  /// held by Kinematics.
  void place(Needs wanted) {
    if (wanted.position) x_.resize(mass_.size() * 3);
    if (wanted.velocity) v_.resize(mass_.size() * 3);
    if (wanted.position || wanted.velocity || wanted.tangent) {
      const auto& segments = kinematics_.segments();
      for (std::size_t i = 0; i < segments.size(); ++i) {
        for (std::size_t b = segments[i].first_block; b < segments[i].last_block; ++b) {
          place(i, b, wanted);
        }
      }
    }
  }
  /// Points of one strand, as placed.
  Points points(std::size_t strand, Needs wanted) const {
    const auto part = [&](const std::vector<double>& of_all, std::size_t size,
                          bool filled) {
      return filled ? tress::In(of_all).subspan(size * strand * count_, size * count_)
                    : tress::In{};
    };
    return {.count = static_cast<int>(count_),
            .x = part(x_, 3, wanted.position),
            .v = part(v_, 3, wanted.velocity),
            .tangent = part(tangent_, 3, wanted.tangent),
            .mass = part(mass_, 1, true),
            .length = part(length_, 1, true)};
  }

  /// blocks (9 per point) = pos df/dx + vel df/dv at the points as placed.
  void derivatives(double t, double pos, double vel, InOut blocks) const {
    derivatives(t, pos, vel, blocks, [](const Effect&) { return true; });
  }
  /// Computes derivatives() of the effects without couplings.
  void uncoupled_derivatives(double t, double pos, double vel, InOut blocks) const {
    derivatives(t, pos, vel, blocks,
                [](const Effect& effect) { return !effect.needs().couplings; });
  }
  /// blocks = df/dt, t the tangents, summed over all effects that depend on them.
  void direction_derivatives(double t, InOut blocks) const {
    std::ranges::fill(blocks, 0.0);
    const Points p = points(0, needs_of_[0]);
    for (const auto& effect : effects_[0]) {
      effect->add_direction_derivatives(t, p, 1, blocks);
    }
  }
  /// Couplings of the effects of the first strand.
  void couplings(double t, std::vector<Coupling>& all) const {
    all.clear();
    const Points p = points(0, needs_of_[0]);
    for (const auto& effect : effects_[0]) effect->add_couplings(t, p, all);
  }

  // From the last residual(): the inertial force at each point and the loads alone, in
  // the components of the segment's start, and the wrench on each tip.
  const Vec3<Pack>& load(std::size_t block) const { return force_[block].load; }
  const Vec3<Pack>& force(std::size_t block) const { return force_[block].total; }
  const Wrench& at_tip(std::size_t i) const { return at_tip_[i]; }
  const Wrench& at_root() const { return at_root_; }
  const Needs& effect_needs() const { return needs_; }
  const Effects& effects(std::size_t strand) const { return effects_[strand]; }

 private:
  using Vec = Vec3<Real>;
  using Frame = FrameOf<Real>;
  using FrameMotion = FrameMotionOf<Real>;

  struct Force {
    Vec3<Pack> total, load;
  };

  /// I d/dt((omega . t) t), t = e0 of the frame.
  static Vec rotor_moment(const Real& inertia, const FrameMotion& m) {
    const Vec& w = m.omega;
    return inertia * Vec{m.alpha.x, w.x * w.z, -1.0 * (w.x * w.y)};
  }

  template <class Accept>
  void derivatives(double t, double pos, double vel, InOut blocks, Accept accept) const {
    std::ranges::fill(blocks, 0.0);
    for (std::size_t strand = 0; strand < effects_.size(); ++strand) {
      const Points p = points(strand, needs_of_[strand]);
      const InOut own = blocks.subspan(9 * strand * count_, 9 * count_);
      for (const auto& effect : effects_[strand]) {
        if (accept(*effect)) effect->add_derivatives(t, p, pos, vel, own);
      }
    }
  }

  void place(std::size_t i, std::size_t b, Needs wanted) {
    const auto& block = kinematics_.block_geometry(b);
    const auto scatter = [&](const Vec3<Pack>& x, std::vector<double>& to) {
      scatter3(x, &to[3 * K::first_point(b)], 3 * kinematics_.point_step());
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

  void segment(std::size_t i, In q, In v, Out r) {
    const typename K::Segment& segment = kinematics_.segments()[i];
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
      if (loaded_) {
        const Vec3<Pack> world =
            gather3(&load_[3 * K::first_point(b)], 3 * kinematics_.point_step());
        at.load = {dot(e0, world), dot(e1, world), dot(e2, world)};
        at.total = at.total - at.load;
      }
      sum_force = sum_force + at.total;
      sum_moment = sum_moment + cross(p, at.total);
      for (int k = 0; k < dofs; ++k) sum_r[k] += dot(block.slope[k], at.total);
    }
    const auto kappa = K::components(q, i);
    const auto rate = K::components(v, i);
    for (int k = 0; k < dofs; ++k) {
      const auto e = K::unit(k);
      r[dofs * i + static_cast<std::size_t>(k)] =
          sum_over<Real>(sum_r[k]) + dot(g.slope[k], force) + dot(g.turn[k], moment) +
          dot(e, segment.stiffness) * dot(e, kappa - segment.rest) +
          dot(e, segment.friction) * dot(e, rate);
      if constexpr (Kernel::functions == 2) {
        r[dofs * i + static_cast<std::size_t>(k)] +=
            dot(e, segment.inertia) * dot(e, m.acceleration);
      }
    }
    Wrench start{sum_over<Real>(sum_force) + force,
                 sum_over<Real>(sum_moment) + moment + cross(g.position, force)};
    if (segment.mounted) {
      start = {segment.mount * start.force, segment.mount * start.moment};
    }
    Wrench& parent =
        segment.parent < 0 ? at_root_ : at_tip_[static_cast<std::size_t>(segment.parent)];
    parent = {parent.force + start.force, parent.moment + start.moment};
  }

  K& kinematics_;
  std::size_t count_;                                // points per strand
  std::vector<Effects> effects_;                     // per strand
  std::vector<std::vector<const Effect*>> loading_;  // per strand, not uniform
  bool loaded_ = false;
  Needs needs_;
  std::vector<Needs> needs_of_;  // per strand
  std::vector<double> x_, v_, tangent_, mass_, length_, load_;
  std::vector<Force> force_;
  std::vector<Wrench> at_tip_;
  Wrench at_root_;
};

}  // namespace tress::models
