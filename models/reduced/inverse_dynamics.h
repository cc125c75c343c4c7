#pragma once

#include <cmath>

#include "contract/forms/loaded_tangent.h"
#include "math/wrench.h"
#include "models/effects/effect.h"
#include "models/reduced/kinematics.h"

namespace tress::models {

/// The residual of a reduced-coordinate tree by the recursive Newton-Euler scheme. Motion
/// goes from the root to the tips (Kinematics), d'Alembert forces m p'' - f act at the
/// quadrature points, and wrenches go from the tips to the root. Gravity is an
/// acceleration of the root [Luh, Walker, Paul 1980]. O(N).
template <class Kernel, int modes>
class InverseDynamics {
  using K = Kinematics<Kernel, modes>;
  using Real = typename K::Real;
  using In = std::span<const Real>;
  using Out = std::span<Real>;
  using Wrench = WrenchOf<Real>;
  static constexpr int dofs = K::dofs;

 public:
  /// Takes the effects on the points. Uniform accelerations become Kinematics::fall(),
  /// all others load the points. `kinematics` must outlive it.
  InverseDynamics(K& kinematics, Effects effects)
      : kinematics_(kinematics), effects_(std::move(effects)), needs_(needs(effects_)) {
    for (const auto& effect : effects_) {
      if (!effect->uniform_acceleration()) loading_.push_back(effect.get());
      if (depends_on_place(*effect)) placed_.push_back(effect.get());
    }
    kinematics.fall(uniform_acceleration(effects_));
    const std::size_t blocks = kinematics.blocks().size(), all = kinematics.points();
    load_.resize(3 * all);
    mass_.resize(all);
    length_.resize(all);
    arc_.resize(all);
    for (std::size_t b = 0; b < blocks; ++b) {
      for (int lane = 0; lane < Pack::lanes; ++lane) {
        const std::size_t at = K::first_point(b) + static_cast<std::size_t>(lane);
        mass_[at] = kinematics.blocks()[b].mass[lane];
        length_[at] = kinematics.blocks()[b].length[lane];
      }
    }
    place_along();
    if (needs_.position) x_.resize(3 * all);
    if (needs_.velocity) v_.resize(3 * all);
    if (needs_.tangent) tangent_.resize(3 * all);
    force_.resize(blocks);
    at_tip_.resize(kinematics.segments().size());
  }

  /// Writes the residual r, as System::residual(), and moves the kinematics to the state.
  void residual(double t, In q, In v, In a, Out r) {
    kinematics_.move(t, q, v, a);
    if (loaded()) {
      place(needs_);
      find_loads(t);
    }
    for (Wrench& wrench : at_tip_) wrench = {};
    at_root_ = {};
    for (std::size_t i = at_tip_.size(); i-- > 0;) segment(i, q, v, r);
    if (!kinematics_.free()) return;
    at_root_.moment =
        at_root_.moment + rotor_moment(kinematics_.root_rotor(), kinematics_.root());
    kinematics_.free_root().residual(at_root_.force, at_root_.moment, r.last(6));
  }

  /// Whether some effect is not uniform.
  bool loaded() const { return !loading_.empty(); }
  /// Whether some effect is neither uniform nor viscous.
  bool pushed() const { return !placed_.empty(); }
  /// Whether some such effect has derivatives.
  bool stiffened() const {
    return std::ranges::any_of(placed_,
                               [](const Effect* e) { return e->needs().derivatives; });
  }
  /// Returns the loads of such effects on the points as placed (3 numbers each, N).
  tress::In find_loads(double t) { return find_loads(t, points(needs_)); }
  /// Returns the loads of these effects on other points.
  tress::In find_loads(double t, const Points& p) { return loads_of(loading_, t, p); }
  /// Returns the loads of effects that are neither uniform nor viscous.
  tress::In find_placed_loads(double t) { return loads_of(placed_, t, points(needs_)); }
  /// Arrays that place() fills, for callers that place the points themselves.
  struct Places {
    tress::Out x, v, tangent;  // 3 numbers per point; empty where no effect reads them
  };
  /// Returns the arrays that place() fills.
  Places places() { return {x_, v_, tangent_}; }

  /// Fills the `wanted` quantities of the points on which effects act, at the motion of
  /// Kinematics.
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
  /// Returns the `wanted` quantities of the points as placed.
  Points points(Needs wanted) const {
    const auto filled = [](const std::vector<double>& all, bool is) {
      return is ? tress::In(all) : tress::In{};
    };
    return {.count = static_cast<int>(mass_.size()),
            .x = filled(x_, wanted.position),
            .v = filled(v_, wanted.velocity),
            .tangent = filled(tangent_, wanted.tangent),
            .mass = mass_,
            .length = length_,
            .arc = arc_,
            .longest = longest_,
            .since = kinematics_.since()};
  }

  /// Writes blocks (9 per point) = pos df/dx + vel df/dv at the points as placed.
  void derivatives(double t, double pos, double vel, InOut blocks) const {
    derivatives(t, pos, vel, blocks, [](const Effect&) { return true; });
  }
  /// Subtracts vel times the drag per velocity of viscous effects from blocks (9 per
  /// point) of -vel df/dv.
  void subtract_viscous(double vel, InOut blocks) const {
    const Viscosity air = viscosity(effects_);
    for (std::size_t i = 0; i < mass_.size(); ++i) {
      const double rate = air.per_length * length_[i] + air.per_mass * mass_[i];
      for (const std::size_t k : {0, 4, 8}) blocks[9 * i + k] -= vel * rate;
    }
  }
  /// Writes derivatives() of the effects that couple no points.
  void uncoupled_derivatives(double t, double pos, double vel, InOut blocks) const {
    derivatives(t, pos, vel, blocks,
                [](const Effect& effect) { return !effect.needs().couplings; });
  }
  /// Writes blocks (9 per point) = df/dt, t the tangents, summed over all effects.
  void direction_derivatives(double t, InOut blocks) const {
    std::ranges::fill(blocks, 0.0);
    const Points p = points(needs_);
    for (const auto& effect : effects_) {
      effect->add_direction_derivatives(t, p, 1, blocks);
    }
  }
  /// Replaces `all` by the couplings of the effects at the points as placed.
  void couplings(double t, std::vector<Coupling>& all) const {
    all.clear();
    const Points p = points(needs_);
    for (const auto& effect : effects_) effect->add_couplings(t, p, all);
  }

  // From the last residual(), in the components of each segment's start.
  /// Returns the loads on a block of points, N.
  const Vec3<Pack>& load(std::size_t block) const { return force_[block].load; }
  /// Returns mass times acceleration less loads of a block of points, N.
  const Vec3<Pack>& force(std::size_t block) const { return force_[block].total; }
  /// Returns the wrench that moves all beyond the tip of segment i, in components of the
  /// tip; from the last residual().
  const Wrench& at_tip(std::size_t i) const { return at_tip_[i]; }
  /// Returns the wrench that moves all segments, in components of the root; from the last
  /// residual().
  const Wrench& at_root() const { return at_root_; }
  /// Adds loads on points (0: the root, i + 1: the tip of segment i) of a chain to what
  /// at_tip() and at_root() return, after residual().
  void hang(std::span<const SectionLoad> loads) {
    Wrench below;  // in components of the tip, or start, that the sweep is at
    const auto take = [&](std::size_t point, const FrameMotion& at) {
      for (const SectionLoad& load : loads) {
        if (load.point != static_cast<int>(point)) continue;
        below.force = below.force - at.frame.back(load.force);
        below.moment = below.moment - at.frame.back(load.moment);
      }
    };
    for (std::size_t i = at_tip_.size(); i-- > 0;) {
      take(i + 1, kinematics_.motion(i).tip);
      Wrench& tip = at_tip_[i];
      tip = {tip.force + below.force, tip.moment + below.moment};
      const auto& g = kinematics_.geometry(i);
      below.force = g.rotation * below.force;
      below.moment = g.rotation * below.moment + cross(g.position, below.force);
      const auto& segment = kinematics_.segments()[i];
      if (!segment.mounted) continue;
      below = {segment.mount * below.force, segment.mount * below.moment};
    }
    take(0, kinematics_.root());
    at_root_ = {at_root_.force + below.force, at_root_.moment + below.moment};
  }
  /// Returns the quantities of points that any of the effects reads.
  const Needs& effect_needs() const { return needs_; }
  /// Returns all effects on the strand.
  const Effects& effects() const { return effects_; }

  /// Returns I d/dt((omega . t) t), t = e0 of the frame.
  static Vec3<Real> rotor_moment(const Real& inertia, const FrameMotionOf<Real>& m) {
    const Vec3<Real>& w = m.omega;
    return inertia * Vec3<Real>{m.alpha.x, w.x * w.z, -1.0 * (w.x * w.y)};
  }

 private:
  using Vec = Vec3<Real>;
  using Frame = FrameOf<Real>;
  using FrameMotion = FrameMotionOf<Real>;

  struct Force {
    Vec3<Pack> total, load;
  };

  tress::In loads_of(const std::vector<const Effect*>& effects, double t,
                     const Points& p) {
    std::ranges::fill(load_, 0.0);
    for (const Effect* effect : effects) effect->add_load(t, p, load_);
    return load_;
  }
  template <class Accept>
  void derivatives(double t, double pos, double vel, InOut blocks, Accept accept) const {
    std::ranges::fill(blocks, 0.0);
    const Points p = points(needs_);
    for (const auto& effect : effects_) {
      if (accept(*effect)) effect->add_derivatives(t, p, pos, vel, blocks);
    }
  }

  /// Sets the arc lengths of all points from the root.
  void place_along() {
    const auto& segments = kinematics_.segments();
    std::vector<double> tip;
    for (const auto& segment : segments) {
      const double start =
          segment.parent < 0 ? 0 : tip[static_cast<std::size_t>(segment.parent)];
      tip.push_back(start + segment.length);
      longest_ = std::max(longest_, tip.back());
      for (std::size_t b = segment.first_block; b < segment.last_block; ++b) {
        for (int lane = 0; lane < Pack::lanes; ++lane) {
          arc_[K::first_point(b) + static_cast<std::size_t>(lane)] =
              start + kinematics_.blocks()[b].s[lane];
        }
      }
    }
  }

  void place(std::size_t i, std::size_t b, Needs wanted) {
    const auto& block = kinematics_.block_geometry(b);
    const auto scatter = [&](const Vec3<Pack>& x, std::vector<double>& to) {
      scatter3(x, &to[3 * K::first_point(b)], 3);
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
      if (loaded()) {
        const Vec3<Pack> world = gather3(&load_[3 * K::first_point(b)], 3);
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
  Effects effects_;
  Needs needs_;
  std::vector<const Effect*> loading_;  // effects that are not uniform
  std::vector<const Effect*> placed_;   // those of them that are not viscous
  std::vector<double> x_, v_, tangent_, mass_, length_, arc_, load_;
  double longest_ = 0;  // arc length of the farthest tip
  std::vector<Force> force_;
  std::vector<Wrench> at_tip_;
  Wrench at_root_;
};

}  // namespace tress::models
