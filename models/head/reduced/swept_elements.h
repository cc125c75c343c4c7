#pragma once

#include <algorithm>
#include <cstring>
#include <limits>

#include "math/instructions.h"
#include "math/lanes.h"
#include "models/effects/effect.h"
#include "models/head/reduced_kernel.h"
#include "models/reduced/strand_sweeps.h"

namespace tress::models {

/// StrandSweepsOf a Kind of element. It keeps the motion at the last two states for later
/// calls at one of them.
template <class Kind, bool twist>
class SweptElements final : public StrandSweepsOf<typename Kind::Real> {
  using T = typename Kind::Real;
  using In = std::span<const T>;
  using Out = std::span<T>;
  using V = Vec3<T>;
  using Kernel = ReducedKernel<Kind>;

 public:
  /// Copies the data of the strands. `points`: result of swept_points().
  SweptElements(const ToSweep& of, int points)
      : strands_(of.strands),
        each_(strands_.size()),
        places_(strands_.size()),
        kernel_(static_cast<int>(of.made.front()->segments.size()), points, twist),
        padded_((static_cast<std::size_t>(points) + Pack::lanes - 1) / Pack::lanes *
                Pack::lanes),
        elements_(of.made.front()->segments.size()),
        states_{State(elements_.size()), State(elements_.size())},
        frames_(elements_.size()),
        loads_(elements_.size()) {
    for (int lane = 0; lane < lanes<T>; ++lane) {
      describe(*of.made[of_lane(lane)], lane);
    }
  }

  void set_rest(In values) override {
    for (std::size_t i = 0; i < elements_.size(); ++i) {
      elements_[i].rest = elements_[i].held + load(values, i, T(0));
    }
  }

  void residual(double t, In q, In v, In a, Out r) noexcept override {
    place(t, q, v, a);
    const bool loaded = std::ranges::any_of(
        strands_, [](const SweptStrand* strand) { return strand->loaded(); });
    if (loaded) {
      place_points();
      for (std::size_t k = 0; k < strands_.size(); ++k) each_[k] = strands_[k]->loads(t);
      take_loads();
    }
    sweep_wrenches(loaded, r);
  }

  bool factor(double t, In q, In v, In a, Weights w) noexcept override {
    place(t, q, v, a);
    factored_ = now_;
    const bool stiffened =
        (w.vel != 0 || w.pos != 0) &&
        std::ranges::any_of(strands_, [](const auto* s) { return s->stiffened(); });
    if (stiffened) {
      place_points();
      for (std::size_t k = 0; k < strands_.size(); ++k) {
        each_[k] = strands_[k]->stiffness(t, w);
      }
      take_blocks();
    }
    return eliminate(w, stiffened);
  }

  TRESS_FLATTEN void solve(In b, Out x) noexcept override {
    WrenchOf<T> wrench{};
    for (std::size_t i = elements_.size(); i-- > 0;) {
      Scratch& e = factored_->elements[i].sweep;
      V right = load(b, i, T(0));
      Kind::lift(e.kept, wrench, right);
      Kind::reduce(right, twist, e.joint, e, wrench);
      Kind::set_back(e.kept, wrench);
    }
    V l, a;
    for (std::size_t i = 0; i < elements_.size(); ++i) {
      const Scratch& e = factored_->elements[i].sweep;
      store(Kind::follow(e, twist, e.joint, l, a), i, x);
    }
  }

 private:
  using Material = ReducedMaterial<T>;
  using Scratch = typename Kernel::Scratch;
  /// Constants of an element.
  struct Fixed {
    Material material;
    V friction, held, rest;
  };
  struct Element {
    Scratch sweep;
    typename Kind::Sums sums;
    V v;
  };
  struct State {
    explicit State(std::size_t n)
        : q((twist ? 3 : 2) * n), v(q.size()), a(q.size()), elements(n) {}
    bool is(double at, In of_q, In of_v, In of_a) const {
      return at == t && same(of_q, q) && same(of_v, v) && same(of_a, a);
    }
    double t = std::numeric_limits<double>::quiet_NaN();
    std::vector<T> q, v, a;
    std::vector<Element> elements;
    FrameOf<T> frame;  // clamp
    V x;
    ReducedMotion<T> end;  // motion of the tip
  };

  /// Whether a and b have the same bits.
  static bool same(In a, In b) {
    return std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
  }

  std::size_t of_lane(int lane) const {
    const auto k = static_cast<std::size_t>(lane);
    return k < strands_.size() ? k : 0;
  }
  void describe(const ReducedStrand& strand, int lane) {
    double before = strand.root_rotor;
    const Viscosity air = viscosity(strand.effects);
    for (std::size_t i = 0; i < elements_.size(); ++i) {
      const ReducedSegment& segment = strand.segments[i];
      const PointBlock& first = strand.blocks[segment.first_block];
      Fixed& e = elements_[i];
      set_lane(e.material.length, lane, segment.length);
      const double density = first.mass[0] / first.length[0];
      set_lane(e.material.density, lane, density);
      set_lane(e.material.drag, lane, air.per_length + air.per_mass * density);
      set_lane(e.material.stiffness, lane, segment.stiffness.mean);
      set_lane(e.material.rotor, lane, Kind::rotors_of_root > 0 ? before : segment.rotor);
      set_lane(e.friction, lane, segment.friction.mean);
      set_lane(e.held, lane, segment.held.mean);
      set_lane(e.rest, lane, segment.held.mean + segment.rest.mean);
      before = segment.rotor;
    }
    // The tip carries half of this rotor.
    set_lane(last_.rotor, lane, 2 * before);
  }

  static V load(In x, std::size_t i, const T& first) {
    if constexpr (twist) {
      return {x[3 * i], x[3 * i + 1], x[3 * i + 2]};
    } else {
      return {first, x[2 * i], x[2 * i + 1]};
    }
  }
  static void store(const V& value, std::size_t i, Out x) {
    if constexpr (twist) {
      x[3 * i] = value.x;
      x[3 * i + 1] = value.y;
      x[3 * i + 2] = value.z;
    } else {
      x[2 * i] = value.y;
      x[2 * i + 1] = value.z;
    }
  }

  void place(double t, In q, In v, In a) noexcept {
    for (State& state : states_) {
      if (!state.is(t, q, v, a)) continue;
      now_ = &state;
      return;
    }
    now_ = &states_[factored_ == &states_[0] ? 1 : 0];
    now_->t = t;
    std::ranges::copy(q, now_->q.begin());
    std::ranges::copy(v, now_->v.begin());
    std::ranges::copy(a, now_->a.begin());
    for (int lane = 0; lane < lanes<T>; ++lane) {
      const FrameMotion clamp = strands_[of_lane(lane)]->clamp(t);
      set_lane(now_->frame, lane, clamp.frame);
      set_lane(now_->x, lane, clamp.x);
      set_lane(now_->end.v, lane, clamp.v);
      set_lane(now_->end.omega, lane, clamp.omega);
      set_lane(now_->end.a, lane, clamp.a);
      set_lane(now_->end.alpha, lane, clamp.alpha);
    }
    move(*now_);
  }

  TRESS_FLATTEN void move(State& state) noexcept {
    for (std::size_t i = 0; i < elements_.size(); ++i) {
      const Material& m = elements_[i].material;
      Element& e = state.elements[i];
      e.sweep.q = load(state.q, i, elements_[i].held.x);
      e.v = load(state.v, i, T(0));
      const V a = load(state.a, i, T(0));
      Kind::template move<true>({}, m, e.sweep.q, e.v, a, state.end, e.sweep.kept);
      Kind::template add_up<true>(kernel_, m, e.sweep.q, e.v, a, e.sweep.kept, e.sums);
    }
  }

  std::size_t points() const { return static_cast<std::size_t>(kernel_.points()); }
  /// Place of a point. Points that only fill a pack lie in the middle.
  PointPlace<T> place_of(std::size_t i, std::size_t k) const {
    const T& length = elements_[i].material.length;
    const int number = static_cast<int>(k);
    return {number, T(k < points() ? kernel_.at(number) : 0.5) * length};
  }
  typename Kind::Points points_of(std::size_t i) const {
    const Element& e = now_->elements[i];
    return {e.sweep.kept, e.sweep.q, e.v, elements_[i].material.length};
  }

  void place_points() noexcept {
    for (std::size_t k = 0; k < strands_.size(); ++k) places_[k] = strands_[k]->places();
    FrameOf<T> frame = now_->frame;
    V start = now_->x;
    for (std::size_t i = 0; i < elements_.size(); ++i) {
      const Element& e = now_->elements[i];
      Kind::enter(e.sweep.kept, frame);
      frames_[i] = frame;
      const auto on = points_of(i);
      for (std::size_t k = 0; k < padded_; ++k) {
        const PointPlace<T> place = place_of(i, k);
        const V position = on.position(place);
        put(padded_ * i + k, start + frame * position,
            frame * on.velocity(place, position), frame * on.tangent(place));
      }
      start = start + frame * e.sweep.kept.position;
      Kind::go_on(e.sweep.kept, frame);
    }
  }
  void put(std::size_t point, const V& x, const V& v, const V& tangent) noexcept {
    for (std::size_t k = 0; k < strands_.size(); ++k) {
      const auto lane = static_cast<int>(k);
      const SweptStrand::Places& to = places_[k];
      if (!to.x.empty()) store3(lane_of(x, lane), &to.x[3 * point]);
      if (!to.v.empty()) store3(lane_of(v, lane), &to.v[3 * point]);
      if (!to.tangent.empty()) store3(lane_of(tangent, lane), &to.tangent[3 * point]);
    }
  }
  /// Returns number k that each strand has given, or 0 where it has given none.
  T given(std::size_t k) const {
    T all(0);
    for (std::size_t strand = 0; strand < each_.size(); ++strand) {
      if (!each_[strand].empty()) {
        set_lane(all, static_cast<int>(strand), each_[strand][k]);
      }
    }
    return all;
  }

  void take_loads() noexcept {
    for (std::size_t i = 0; i < elements_.size(); ++i) {
      LoadSums<T>& all = loads_[i];
      all.some = T(1);
      all.force = all.moment = all.unknown = {};
      const auto on = points_of(i);
      for (std::size_t k = 0; k < points(); ++k) {
        const PointPlace<T> place = place_of(i, k);
        const std::size_t at = 3 * (padded_ * i + k);
        on.add_force(place, on.position(place),
                     frames_[i].back({given(at), given(at + 1), given(at + 2)}), all);
      }
    }
  }
  void take_blocks() noexcept {
    for (std::size_t i = 0; i < elements_.size(); ++i) {
      LoadSums<T> all;
      all.some = T(1);
      const Matrix3<T> back{{frames_[i].e0, frames_[i].e1, frames_[i].e2}};
      const auto on = points_of(i);
      for (std::size_t k = 0; k < points(); ++k) {
        const std::size_t at = 9 * (padded_ * i + k);
        const Symmetric3<T> block{given(at),     given(at + 4), given(at + 8),
                                  given(at + 1), given(at + 2), given(at + 5)};
        const PointPlace<T> place = place_of(i, k);
        on.add_block(place, on.position(place), congruent(back, block), all);
      }
      loads_[i] = all;
    }
  }

  static V times(const V& a, const V& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
  static V bending(const Fixed& fixed, const Element& e) {
    return times(fixed.material.stiffness, e.sweep.q - fixed.rest) +
           times(fixed.friction, e.v);
  }

  TRESS_FLATTEN void sweep_wrenches(bool loaded, Out r) noexcept {
    WrenchOf<T> wrench = Kind::last_wrench(last_, now_->end);
    for (std::size_t i = elements_.size(); i-- > 0;) {
      const Element& e = now_->elements[i];
      V unknown;
      Kind::bear(e.sweep.q, e.v, e.sums, loaded ? &loads_[i] : nullptr, e.sweep.kept,
                 wrench, unknown);
      store(bending(elements_[i], e) - Kind::felt(e.sweep.kept, wrench, unknown), i, r);
      Kind::pass_wrench(elements_[i].material, e.sweep.kept, wrench);
    }
  }

  TRESS_FLATTEN bool eliminate(Weights w, bool stiffened) noexcept {
    const T most_growth(100);  // of rounding errors, as in RecursiveSolver
    const T acc(w.acc), pos(w.pos), vel(w.vel);
    bool accurate = true;
    ArticulatedInertia<T> hanging = Kind::last(last_, acc);
    for (std::size_t i = elements_.size(); i-- > 0;) {
      const Fixed& fixed = elements_[i];
      Element& e = now_->elements[i];
      typename Kernel::Uneliminated all;
      const ReducedInertia<T> inertia{
          acc * fixed.material.density + vel * fixed.material.drag, acc};
      Kind::carry(fixed.material, inertia, e.sweep.q, e.v, e.sums, hanging,
                  stiffened ? &loads_[i] : nullptr, e.sweep.kept, all);
      hanging = Kind::eliminate(pos * fixed.material.stiffness + vel * fixed.friction,
                                twist, all, e.sweep, e.sweep.joint);
      const Symmetric3<T>& p = e.sweep.pivot;
      if constexpr (Kind::cancels) {
        accurate = accurate && !any_less(most_growth, all.own.xx * p.xx) &&
                   !any_less(most_growth, all.own.yy * p.yy) &&
                   !any_less(most_growth, all.own.zz * p.zz);
      }
      accurate = accurate && is_finite(p.xx + p.yy + p.zz);
      Kind::pass(fixed.material, acc, e.sweep.kept, hanging);
    }
    return accurate;
  }

  std::vector<SweptStrand*> strands_;
  std::vector<tress::In> each_;  // loads or stiffness that each strand has given
  std::vector<SweptStrand::Places> places_;
  Kernel kernel_;
  std::size_t padded_;  // points of an element, including those that fill a pack
  std::vector<Fixed> elements_;
  Material last_{};  // rotor of the tip
  State states_[2];
  State *now_ = &states_[0], *factored_ = nullptr;
  std::vector<FrameOf<T>> frames_;  // axes of elements, from place_points()
  std::vector<LoadSums<T>> loads_;  // loads or stiffness of elements
};

/// Returns the number of points of an element that carry mass, 0 if the strands differ or
/// cannot be swept.
inline int swept_points(const ToSweep& of, int modes) {
  const auto points_of = [](const ReducedStrand& strand) {
    int before = -1, carrying = 0;
    for (const ReducedSegment& segment : strand.segments) {
      if (segment.mounted || segment.parent != before++) return 0;
    }
    const ReducedSegment& first = strand.segments.front();
    for (std::size_t b = first.first_block; b < first.last_block; ++b) {
      for (int lane = 0; lane < Pack::lanes; ++lane) {
        if (strand.blocks[b].mass[lane] > 0) ++carrying;
      }
    }
    const bool can = !strand.free_root && strand.method == TreeMethod::recursive &&
                     carrying <= most_points_of_element;
    return can ? carrying : 0;
  };
  const ReducedStrand& first = *of.made.front();
  const int points = modes < 2 ? 0 : points_of(first);
  const bool alike = std::ranges::all_of(of.made, [&](const ReducedStrand* one) {
    return one->segments.size() == first.segments.size() && points_of(*one) == points;
  });
  return alike ? points : 0;
}

/// Makes sweeps of strands of this Kind of element. Returns null if the strands cannot be
/// swept.
template <class Kind>
std::unique_ptr<StrandSweepsOf<typename Kind::Real>> sweeps_of(const ToSweep& of,
                                                               int modes) {
  const int points = swept_points(of, modes);
  if (points == 0) return nullptr;
  if (modes == 3) return std::make_unique<SweptElements<Kind, true>>(of, points);
  return std::make_unique<SweptElements<Kind, false>>(of, points);
}

}  // namespace tress::models
