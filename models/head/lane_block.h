#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "models/head/head_bodies.h"
#include "models/head/lane_head.h"
#include "models/head/lane_kernel.h"
#include "models/head/lane_memory.h"

namespace tress::models {

/// A LaneModel with what acts on all of its strands.
template <LaneModel Model>
class ModelLanes final : public LaneKernel<typename Model::Real::Scalar> {
 public:
  /// Scalar: a number, or a pack of SIMD lanes.
  using T = typename Model::Real;
  /// Number of a lane.
  using N = typename T::Scalar;
  /// Data of strands in blocks.
  using Memory = LaneMemory<Model>;

  /// Makes the model with what acts on all strands.
  explicit ModelLanes(const LaneOptions& options)
      : options_(with_uniform_effects(options)),
        units_(HeadUnits::of(options.longest)),
        model_(options_, units_) {
    options_.motion.frame = {};
    for (const auto& effect : options_.effects) {
      check_for_head(*effect);
      refuse_if(!Model::takes_bodies || effect->rigid_contact() == nullptr,
                on_this_model(*effect), place_of_head, Model::use_others);
      bodies_.add(effect->rigid_contact());
    }
  }

  int lanes() const override { return T::lanes; }
  std::size_t elements() const override { return model_.elements(); }
  std::size_t unknowns() const override { return model_.unknowns(); }
  std::unique_ptr<StrandMemory> memory() const override {
    return std::make_unique<Memory>(model_);
  }
  std::unique_ptr<Block<N>> block() const override;

  void admit(const models::Strand& strand, const Effects& own) override {
    models::check(strand);
    check_for_head(strand, elements());
    refuse_if(!own.empty(), own.empty() ? "" : on_this_model(*own.front()), place_of_head,
              Model::use_others);
    units_.weigh(options_.line_density,
                 strand.material.density * strand.segments.front().section.area());
    if constexpr (Model::takes_bodies) {
      bodies_.include(norm(strand.root.position - options_.motion.position) +
                      Model::most_stretched * static_cast<double>(elements()) *
                          strand.segments.front().length);
    }
  }
  void describe(const models::Strand& strand, LanePlace to, StrandMemory& memory, N* q,
                N* v) const override {
    models::Strand in_head = strand;
    in_head.root = options_.motion;
    in_head.root.position = strand.root.position;
    in_head.root.frame = strand.root.frame;
    if (!in_head.root.centre) in_head.root.centre = options_.motion.position;
    auto& own = static_cast<Memory&>(memory);
    model_.describe(in_head, options_.motion.position, units_, to.lane,
                    own.strand(to.block), own.elements(to.block), packs(q), packs(v));
  }

  void positions(const StrandMemory& memory, std::size_t block, double t, const N* q,
                 std::size_t strands, std::span<double> x) const override {
    const RootPose of_head = options_.motion.at(t);
    model_.positions(of(memory).strand(block), of_head.frame, packs(q),
                     [&](std::size_t i, const Vec3<T>& at) {
                       for (std::size_t k = 0; k < strands; ++k) {
                         store3(
                             of_head.x + units_.length * lane_of(at, static_cast<int>(k)),
                             &x[3 * (k * (elements() + 1) + i)]);
                       }
                     });
  }
  void velocities(const StrandMemory& memory, std::size_t block, double t, const N* q,
                  const N* v, std::size_t strands, std::span<double> u) const override {
    model_.velocities(of(memory).strand(block), pose(t), packs(q), packs(v),
                      [&](std::size_t i, const Vec3<T>& at) {
                        for (std::size_t k = 0; k < strands; ++k) {
                          store3(units_.speed() * lane_of(at, static_cast<int>(k)),
                                 &u[3 * (k * (elements() + 1) + i)]);
                        }
                      });
  }
  void ahead(const StrandMemory& memory, std::size_t block, double t, double h,
             const N* q, const N* v, std::size_t strands, std::span<double> x,
             std::span<double> bulge) const override {
    std::vector<T> next(unknowns());
    const auto& strand = of(memory).strand(block);
    model_.predict(strand, pose(t), pose(t + h), h / units_.time, packs(q), packs(v),
                   next.data());
    positions(memory, block, t + h, reinterpret_cast<const N*>(next.data()), strands, x);
    const std::size_t numbers = 3 * (elements() + 1);
    for (std::size_t k = 0; k < strands; ++k) {
      if constexpr (Model::straight) {
        bulge[k] = 0;
      } else {
        bulge[k] = largest_bulge(
            x.subspan(numbers * k, numbers),
            rounded_up<T> * units_.length *
                lane_of(model_.element_length(strand), static_cast<int>(k)));
      }
    }
  }
  void state(int lane, const N* q, const N* v, std::span<double> in_q,
             std::span<double> in_v) const override {
    for (std::size_t k = 0; k < unknowns(); ++k) {
      const double unit = model_.unit(units_, k);
      in_q[k] = unit * lane_of(packs(q)[k], lane);
      in_v[k] = unit / units_.time * lane_of(packs(v)[k], lane);
    }
  }
  void energies(const StrandMemory& memory, std::size_t block, double t, const N* q,
                const N* v, std::size_t strands,
                std::span<HeadEnergy> each) const override {
    const auto& strand = of(memory).strand(block);
    const auto sums =
        model_.energies(strand, of(memory).elements(block), pose(t), packs(q), packs(v));
    const Vec from = options_.motion.at(t).x;
    for (std::size_t k = 0; k < strands; ++k) {
      const auto lane = static_cast<int>(k);
      each[k] = sums.of(lane, units_, units_.mass() * model_.mass(strand, lane), from,
                        options_.gravity);
    }
  }

 private:
  class OfThread;

  static const T* packs(const N* x) { return reinterpret_cast<const T*>(x); }
  static T* packs(N* x) { return reinterpret_cast<T*>(x); }
  static const Memory& of(const StrandMemory& memory) {
    return static_cast<const Memory&>(memory);
  }
  // Beyond those that the options' numbers say as well.
  static std::string on_this_model(const Effect& effect) {
    return "effect " + std::string(effect.name()) + " on this model";
  }

  RootPose pose(double t) const {
    RootPose at = options_.motion.at(t);
    const double l = units_.length, tau = units_.time;
    at.x = (1 / l) * at.x;
    at.v = (tau / l) * at.v;
    at.a = (tau * tau / l) * at.a;
    at.omega = tau * at.omega;
    at.alpha = (tau * tau) * at.alpha;
    return at;
  }

  LaneOptions options_;
  HeadUnits units_;
  Model model_;
  HeadBodies bodies_;
};

/// Block of the model's strands.
template <LaneModel Model>
class ModelLanes<Model>::OfThread final : public Block<N> {
 public:
  /// Allocates for one thread.
  explicit OfThread(const ModelLanes& of)
      : of_(of), model_(of.model_), scratch_(of.model_) {}

  int lanes() const override { return T::lanes; }
  std::size_t unknowns() const override { return model_.unknowns(); }
  std::size_t points() const override { return model_.elements() + 1; }
  double time_unit() const override { return of_.units_.time; }
  double newton_part() const override { return Model::newton_part; }
  std::unique_ptr<StrandMemory> memory() const override { return of_.memory(); }

  void work_on(StrandMemory& memory, std::size_t block) override {
    auto& own = static_cast<Memory&>(memory);
    strand_ = &own.strand(block);
    elements_ = own.elements(block);
  }
  void set_step(double from, double to) override {
    set(Instant::start, from);
    set(Instant::end, to);
  }
  void set_stage(double t) override { set(Instant::stage, t); }

  Lanes renew(Instant at, N* q, N* v) override {
    const T renewed =
        model_.renew(elements_, model_.clamp(*strand_, pose(at)), packs(q), packs(v));
    Lanes all = 0;
    if (!any_less(T(0), renewed)) return all;
    for (int lane = 0; lane < T::lanes; ++lane) {
      if (renewed[lane] > 0) all |= Lanes{1} << lane;
    }
    return all;
  }
  void predict(Instant to, double h, const N* q, const N* v, N* q_bar) const override {
    model_.predict(*strand_, pose(Instant::start), pose(to), h, packs(q), packs(v),
                   packs(q_bar));
  }
  void meet(Instant at, double h, const N* q, const N* v) override {
    clamp_ = model_.clamp(*strand_, pose(at));
    if constexpr (Model::takes_bodies) {
      of_.bodies_.look(moments_[index(at)].t, of_.options_.motion, near_);
      model_.find_loads(*strand_, reached(pose(at)), pose(at), of_.units_, h, packs(q),
                        packs(v), scratch_);
    }
  }
  void take_stresses(const N* q, Lanes which) override {
    if constexpr (Model::takes_stresses) {
      T in(0);
      for (int lane = 0; lane < T::lanes; ++lane) {
        if ((which >> lane & 1U) != 0) in.set(lane, 1);
      }
      model_.take_stresses(*strand_, elements_, packs(q), in, scratch_);
    }
  }
  void newton(Weights w, const N* q, const N* v, const N* a, N* correction,
              N* size) override {
    *packs(size) = model_.newton(*strand_, elements_, clamp_, w, packs(q), packs(v),
                                 packs(a), packs(correction), scratch_);
  }
  /// Without an exact Jacobian no method asks for it; what it has serves as well.
  void again(Weights w, const N* q, const N* v, const N* a, N* correction,
             N* size) override {
    if constexpr (Model::iterates) {
      *packs(size) = model_.again(*strand_, elements_, clamp_, w, packs(q), packs(v),
                                  packs(a), packs(correction), scratch_);
    } else {
      newton(w, q, v, a, correction, size);
    }
  }
  double resolved(Weights w, int lane) const override {
    return model_.resolved(*strand_, w, lane);
  }
  void coordinate_size(const N* dq, N* size) const override {
    *packs(size) = model_.coordinate_size(*strand_, packs(dq));
  }
  void positions(Instant at, const N* q, N* x) const override {
    model_.positions(*strand_, pose(at).frame, packs(q), Points{packs(x)});
  }
  void velocities(Instant at, const N* q, const N* v, N* u) const override {
    model_.velocities(*strand_, pose(at), packs(q), packs(v), Points{packs(u)});
  }

 private:
  struct Points {
    T* to;
    void operator()(std::size_t i, const Vec3<T>& at) const { store3(at, to + 3 * i); }
  };
  struct Moment {
    double t = 0;
    RootPose pose;
  };

  static std::size_t index(Instant at) { return static_cast<std::size_t>(at); }
  void set(Instant which, double t) { moments_[index(which)] = {t, of_.pose(t)}; }
  const RootPose& pose(Instant at) const { return moments_[index(at)].pose; }

  /// Bodies that reach strands, at this pose of the head.
  std::span<const NearBody> reached(const RootPose& pose) {
    if (near_.none()) return {};
    const T unit(of_.units_.length), longest(Model::most_stretched * of_.units_.length);
    return HeadBodies::reached<T>(near_, unit * model_.root_at(*strand_, pose.frame),
                                  longest * model_.length(*strand_));
  }

  const ModelLanes& of_;
  const Model& model_;
  typename Model::Strand* strand_ = nullptr;
  typename Model::Element* elements_ = nullptr;
  std::array<Moment, 3> moments_;
  typename Model::Clamp clamp_;
  typename Model::Scratch scratch_;
  HeadBodies::Near near_;
};

template <LaneModel Model>
std::unique_ptr<Block<typename ModelLanes<Model>::N>> ModelLanes<Model>::block() const {
  return std::make_unique<OfThread>(*this);
}

/// ModelLanes of a Model<T>, T the numbers of a pack.
template <template <class> class ModelOf, bool short_numbers = true>
AnyLaneKernel lanes_of(const LaneOptions& options, const HeadPack& pack) {
  return on_pack<AnyLaneKernel, short_numbers>(pack, [&]<class T>() -> AnyLaneKernel {
    return std::unique_ptr<LaneKernel<typename T::Scalar>>(
        std::make_unique<ModelLanes<ModelOf<T>>>(options));
  });
}

}  // namespace tress::models
