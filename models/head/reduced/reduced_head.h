#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "models/head/head_motion.h"
#include "models/head/lane_head.h"
#include "models/head/reduced_energies.h"
#include "models/head/reduced_kernel.h"
#include "models/head/reduced_loads.h"
#include "models/head/reduced_material.h"
#include "models/head/reduced_places.h"

namespace tress::models {

/// A batch of strands of this Kind of element (models/head/reduced_kernel.h), one strand
/// per lane of a block. A step is that of ReducedKernel with the loads of ReducedLoads
/// between its sweeps. Of a strand the batch keeps coordinates, rates, rest shape,
/// material and root.
template <class Kind>
class ReducedHead : public Head {
  using T = typename Kind::Real;
  using Unknowns = typename Kind::Unknowns;
  static constexpr std::size_t per_element = sizeof(Unknowns) / sizeof(T);

 public:
  /// Makes an empty batch. Throws InputError as stiff_helix_head().
  explicit ReducedHead(const LaneOptions& options)
      : options_(with_uniform_effects(options)),
        n_(static_cast<std::size_t>(options.elements)),
        kernel_(options.elements, options.points, options.twist),
        energies_(kernel_),
        units_(HeadUnits::of(options.longest)) {
    options_.motion.frame = {};
    for (const auto& effect : options_.effects) {
      check_for_head(*effect);
      if (effect->rigid_contact() != nullptr) {
        bodies_.push_back(effect->rigid_contact());
      } else {
        others_.push_back(effect.get());
      }
    }
  }

  void reserve(std::size_t strands) override {
    const std::size_t blocks = (strands + width - 1) / width;
    roots_.reserve(blocks);
    materials_.reserve(blocks);
    hurt_.reserve(blocks);
    for (auto* state : {&q_, &v_, &rest_}) state->reserve(n_ * blocks);
    lost_.reserve(strands);
  }

  using Head::add;
  void add(const Strand& strand, Effects own_effects) override {
    models::check(strand);
    check_for_head(strand, n_);
    for (const auto& effect : own_effects) check_for_head(*effect);
    const Segment& first = strand.segments.front();
    const CrossSection& section = first.section;
    const double density = strand.material.density * section.area();
    units_.weigh(options_.line_density, density);
    const bool opens = lost_.size() % width == 0;
    if (opens) {
      roots_.emplace_back();
      materials_.emplace_back();
      hurt_.push_back(0);
      for (auto* state : {&q_, &v_, &rest_}) state->resize(state->size() + n_);
    }
    const std::size_t block = roots_.size() - 1;
    const Vec from = strand.root.position - options_.motion.position;
    radius_ = std::max(radius_, norm(from) + static_cast<double>(n_) * first.length);
    const int own = static_cast<int>(lost_.size() % width);
    // The first strand of a block fills the lanes of those that may not come.
    for (int lane = own; lane < (opens ? T::lanes : own + 1); ++lane) {
      Root& root = roots_[block];
      set_lane(root.from, lane, (1 / units_.length) * from);
      set_lane(root.frame, lane, strand.root.frame);
      set_material<Kind>(strand, options_, units_, lane, materials_[block]);
      for (std::size_t i = 0; i < n_; ++i) {
        const auto start = start_of<Kind>(strand, options_, units_, i);
        set_lane(rest_[n_ * block + i], lane, start.rest);
        set_lane(q_[n_ * block + i], lane, start.initial);
        set_lane(v_[n_ * block + i], lane, decltype(start.rest){});
      }
    }
    lost_.push_back(0);
    if (own_effects.empty() && own_.empty()) return;
    own_.resize(lost_.size());
    own_.back() = std::move(own_effects);
  }

  std::size_t strands() const override { return lost_.size(); }
  std::size_t blocks() const override { return roots_.size(); }
  std::size_t bytes() const override {
    return blocks() * (sizeof(Root) + sizeof(ReducedMaterial<T>) +
                       3 * n_ * sizeof(Unknowns) + 1) +
           lost_.size() + own_.size() * sizeof(Effects);
  }

  std::unique_ptr<Scratch> scratch() const override {
    // Units are known from the first strand on.
    return std::make_unique<Own>(kernel_, units_);
  }

  void step(std::size_t block, double t, double h, Scratch& given) override {
    Own& scratch = static_cast<Own&>(given);
    Unknowns *const q = &q_[n_ * block], *const v = &v_[n_ * block];
    std::copy_n(q, n_, scratch.before.begin());
    if (scratch.t != t + h) look_around(t + h, scratch);
    const ReducedMotion<T> root = root_of(roots_[block], scratch.pose);
    const ReducedMaterial<T>& material = materials_[block];
    const double step = h / units_.time;
    auto* const elements = scratch.elements.data();
    ReducedMotion<T> end;
    by_registers_of<T>([&] { end = kernel_.move(material, root, step, q, v, elements); });
    const typename Kind::Loads* const* loads = nullptr;
    if (const auto reached = reached_by_effects(block, h, scratch)) {
      loads = scratch.loads.find(*reached, v, elements);
    }
    by_registers_of<T>([&] {
      kernel_.linearly_implicit_step(material, end, loads, &rest_[n_ * block], step, q, v,
                                     elements);
    });
    T finite(0);  // 0 or NaN
    for (std::size_t i = 0; i < n_; ++i) {
      const T all = entries_sum(q[i]);
      finite += all - all;
    }
    if (!all_up_to(finite, 0) || hurt_[block] != 0) {
      freeze(block, finite, h, scratch);
    }
  }
  bool lost(std::size_t strand) const override { return lost_[strand] != 0; }
  using Head::losses;
  std::vector<HeadLoss> losses(std::size_t known) const override {
    return losses_.after(known);
  }
  void lose(std::size_t strand) override {
    const std::size_t block = strand / width;
    stop(block, static_cast<int>(strand % width));
    hurt_[block] = 1;
    lost_[strand] = 1;
  }

  std::size_t numbers() const override { return 3 * (n_ + 1); }
  std::size_t strands_of(std::size_t block) const override {
    return std::min(width, lost_.size() - width * block);
  }

  void positions(std::size_t block, double t, std::span<double> x) const override {
    places(block, t).write(strands_of(block), x, {});
  }
  void motion(std::size_t block, double t, std::span<double> x,
              std::span<double> v) const override {
    places(block, t).write(strands_of(block), x, v);
  }
  /// The points of an arc of length l over a chord c are at most sqrt(l^2 - c^2)/2 from
  /// the chord. The length includes the rounding of chords.
  void ahead(std::size_t block, double t, double h, std::span<double> x,
             std::span<double> bulge) const override {
    std::vector<Unknowns> q(n_);
    const T step(h / units_.time);
    for (std::size_t i = 0; i < n_; ++i) {
      q[i] = q_[n_ * block + i] + step * v_[n_ * block + i];
    }
    ReducedPlaces<Kind> next = places(block, t + h);
    next.q = q.data();
    next.write(strands_of(block), x, {});
    for (std::size_t k = 0; k < strands_of(block); ++k) {
      bulge[k] =
          Kind::straight
              ? 0
              : largest_bulge(x.subspan(3 * (n_ + 1) * k, 3 * (n_ + 1)),
                              rounded_up<T> * units_.length *
                                  lane_of(materials_[block].length, static_cast<int>(k)));
    }
  }
  void state(std::size_t strand, std::span<double> q,
             std::span<double> v) const override {
    const auto lane = static_cast<int>(strand % width);
    const double unit = Kind::unit(units_.length);
    for (std::size_t i = 0; i < n_; ++i) {
      const std::size_t at = n_ * (strand / width) + i, to = per_element * i;
      store_entries((1 / unit) * lane_of(q_[at], lane), &q[to]);
      store_entries(1 / (unit * units_.time) * lane_of(v_[at], lane), &v[to]);
    }
  }

  void energies(std::size_t block, double t, std::span<HeadEnergy> each) const override {
    const RootPose pose = options_.motion.at(t);
    const Root& root = roots_[block];
    const FrameOf<T> head{pose.frame.e0, pose.frame.e1, pose.frame.e2};
    LaneEnergies<T> sums;
    by_registers_of<T>([&] {
      sums = energies_(
          materials_[block], root_of(root, pose), head * root.from, head * root.frame,
          [rest = &rest_[n_ * block]](int i) { return rest[i]; }, &q_[n_ * block],
          &v_[n_ * block]);
    });
    for (std::size_t k = 0; k < strands_of(block); ++k) {
      const auto lane = static_cast<int>(k);
      const double mass = units_.mass() * static_cast<double>(n_) *
                          lane_of(materials_[block].density, lane) *
                          lane_of(materials_[block].length, lane);
      each[k] = sums.of(lane, units_, mass, pose.x, options_.gravity);
    }
  }

  std::size_t kept() const override { return kept_of_state() + 1; }
  std::size_t kept_of_state() const override { return 2 * per_element * n_; }
  void keep(std::size_t block, std::span<double> x) const override {
    double* to = x.data();
    for (std::size_t k = 0; k < strands_of(block); ++k) {
      for (std::size_t i = n_ * block; i < n_ * (block + 1); ++i) {
        store_entries(lane_of(q_[i], static_cast<int>(k)), to);
        store_entries(lane_of(v_[i], static_cast<int>(k)), to + per_element);
        to += 2 * per_element;
      }
      *to++ = lost_[width * block + k];
    }
  }
  void recall(std::size_t block, std::span<const double> x) override {
    const double* from = x.data();
    for (std::size_t k = 0; k < strands_of(block); ++k) {
      for (std::size_t i = n_ * block; i < n_ * (block + 1); ++i) {
        set_lane(q_[i], static_cast<int>(k), entries<OfLane>(from));
        set_lane(v_[i], static_cast<int>(k), entries<OfLane>(from + per_element));
        from += 2 * per_element;
      }
      char& lost = lost_[width * block + k];
      lost = *from++ != 0 ? 1 : 0;
      hurt_[block] = static_cast<char>(hurt_[block] | lost);
    }
  }

 protected:
  static constexpr std::size_t width = T::lanes;

  using Root = LaneRoot<T>;
  /// Unknowns of an element of one strand.
  using OfLane = decltype(lane_of(Unknowns{}, 0));

  /// Working memory of one thread.
  struct Own final : Scratch {
    /// Allocates for a block. `kernel` must outlive it.
    Own(const ReducedKernel<Kind>& kernel, const HeadUnits& units)
        : elements(static_cast<std::size_t>(kernel.elements())),
          before(elements.size()),
          loads(kernel, units),
          others(width) {}
    /// Elements of a block between sweeps (elements).
    std::vector<typename ReducedKernel<Kind>::Scratch> elements;
    std::vector<Unknowns> before;  // unknowns before the step (elements)
    ReducedLoads<Kind> loads;      // loads of effects on the block
    double t = std::numeric_limits<double>::quiet_NaN();  // time of all members below, s
    RootPose pose;                                        // motion of the head at t
    std::vector<NearBody> bodies;                         // bodies that reach the head
    std::vector<const Effect*> all_strands;               // other effects that reach it
    std::vector<NearBody> near;                           // bodies that reach the block
    /// Other effects that reach each strand of the block.
    std::vector<std::vector<const Effect*>> others;
  };

  /// Effects that reach the ball in which all strands are.
  void look_around(double t, Own& scratch) const {
    scratch.t = t;
    scratch.pose = options_.motion.at(t);
    const Ball ball{scratch.pose.x, radius_};
    bodies_around(bodies_, t, ball, scratch.bodies);
    scratch.all_strands.clear();
    for (const Effect* effect : others_) {
      if (effect->reaches(t, ball)) scratch.all_strands.push_back(effect);
    }
  }

  /// A block and the effects that reach some of its strands, if there are any.
  std::optional<typename ReducedLoads<Kind>::Block> reached_by_effects(
      std::size_t block, double h, Own& scratch) const {
    if (scratch.bodies.empty() && scratch.all_strands.empty() && own_.empty()) return {};
    const Root& root = roots_[block];
    const ReducedMaterial<T>& material = materials_[block];
    const Frame& head = scratch.pose.frame;
    const FrameOf<T> axes{head.e0, head.e1, head.e2};
    const Vec3<T> from = T(units_.length) * (axes * root.from);
    const T radius = T(static_cast<double>(n_) * units_.length) * material.length;
    bodies_near<T>(scratch.bodies, from, radius, scratch.near);
    bool others = false;
    if (!scratch.all_strands.empty() || !own_.empty()) {
      for (std::size_t k = 0; k < strands_of(block); ++k) {
        const int lane = static_cast<int>(k);
        const Ball ball{scratch.pose.x + lane_of(from, lane), lane_of(radius, lane)};
        others =
            take_others(width * block + k, ball, scratch, scratch.others[k]) || others;
      }
    }
    if (scratch.near.empty() && !others) return {};
    std::span<const std::vector<const Effect*>> of_strands;
    if (others) of_strands = std::span(scratch.others).first(strands_of(block));
    return typename ReducedLoads<Kind>::Block{&material,    from,      axes * root.frame,
                                              scratch.t,    h,         scratch.pose.x,
                                              scratch.near, of_strands};
  }
  bool take_others(std::size_t strand, const Ball& ball, const Own& scratch,
                   std::vector<const Effect*>& to) const {
    to.clear();
    if (lost_[strand] != 0) return false;
    for (const Effect* effect : scratch.all_strands) {
      if (effect->reaches(scratch.t, ball)) to.push_back(effect);
    }
    if (strand < own_.size()) {
      for (const auto& effect : own_[strand]) {
        if (effect->reaches(scratch.t, ball)) to.push_back(effect.get());
      }
    }
    return !to.empty();
  }

  HeadMotion motion_of(const RootPose& pose) const {
    const double l = units_.length, tau = units_.time;
    const auto in_head = [&](const Vec& x, double unit) {
      return (1 / unit) * pose.frame.back(x);
    };
    return {in_head(pose.v, l / tau), in_head(pose.omega, 1 / tau),
            in_head(pose.a - options_.gravity, l / (tau * tau)),
            in_head(pose.alpha, 1 / (tau * tau))};
  }
  ReducedMotion<T> root_of(const Root& root, const RootPose& pose) const {
    return root_motion(root, motion_of(pose));
  }

  /// Sets the rates of a strand to 0.
  void stop(std::size_t block, int lane) {
    for (std::size_t i = 0; i < n_; ++i) set_lane(v_[n_ * block + i], lane, OfLane{});
  }
  void freeze(std::size_t block, const T& finite, double h, const Own& scratch) {
    for (int lane = 0; lane < T::lanes; ++lane) {
      const std::size_t strand = width * block + static_cast<std::size_t>(lane);
      const bool counts = strand < lost_.size();
      if (finite[lane] == 0 && !(counts && lost_[strand] != 0)) continue;
      for (std::size_t i = 0; i < n_; ++i) {
        set_lane(q_[n_ * block + i], lane, lane_of(scratch.before[i], lane));
      }
      stop(block, lane);
      hurt_[block] = 1;
      if (!counts || lost_[strand] != 0) continue;
      lost_[strand] = 1;
      losses_.add(strand, scratch.t - h, h, "the result of the step is not finite");
    }
  }

  ReducedPlaces<Kind> places(std::size_t block, double t) const {
    const RootPose pose = options_.motion.at(t);
    const Root& root = roots_[block];
    return {pose,
            root.from,
            root.frame,
            root_of(root, pose),
            materials_[block].length,
            n_,
            &kernel_.rule(),
            &q_[n_ * block],
            &v_[n_ * block],
            units_.length,
            units_.speed()};
  }

  LaneOptions options_;
  std::size_t n_;
  ReducedKernel<Kind> kernel_;
  ReducedEnergies<Kind> energies_;
  HeadUnits units_;
  std::vector<const RigidContact*> bodies_;
  std::vector<const Effect*> others_;
  double radius_ = 0;  // of the ball about the head's position that holds all strands, m
  std::vector<Root> roots_;
  std::vector<ReducedMaterial<T>> materials_;
  std::vector<Unknowns> q_, v_, rest_;  // (blocks, elements)
  std::vector<char> lost_;              // of each strand
  HeadLosses losses_;
  std::vector<char> hurt_;    // of each block: whether it has a failed strand
  std::vector<Effects> own_;  // of each strand, or empty
};

/// A ReducedHead of valid options.
template <template <class> class Stepped>
std::unique_ptr<Head> reduced_head(const LaneOptions& options, const HeadPack& pack) {
  check_for_reduced_head(options);
  return on_pack<std::unique_ptr<Head>>(pack, [&]<class T>() -> std::unique_ptr<Head> {
    return std::make_unique<Stepped<T>>(options);
  });
}

}  // namespace tress::models
